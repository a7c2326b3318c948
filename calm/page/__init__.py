"""The line builder in a web page: Python in a Web Worker (Pyodide), with its screen in xterm.js.

`folder` and `archive` write the page; the other modules run in the page.
"""
