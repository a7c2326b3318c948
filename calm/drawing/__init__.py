"""Pictures: side view and plan of a line, its parts, and graphs.

Pictures of a line are first described in metres, independently of the medium. Each medium has a
module that draws them.
"""
