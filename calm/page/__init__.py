"""The line builder in a web page: Python in a Web Worker (Pyodide), with its screen in xterm.js.

`folder` writes the page; `driver`, `builder` and `documents` run in the page.
"""
