"""Published cases, closed forms and an independent continuous solution of the same equations."""
