"""The work on a result, kept on disk block by block until it is whole."""
