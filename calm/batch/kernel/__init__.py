"""The march of many profiles at once, compiled: lanes of profiles pass down the line together."""
