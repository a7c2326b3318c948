"""The line builder in a web page: Python in a Web Worker (Pyodide), the screen in xterm.js.

`folder` writes the page. `driver`, `builder` and `documents` run inside it, and under CPython in
the tests.
"""
