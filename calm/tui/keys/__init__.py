"""Every key that CALM binds, once: bindings, help and command palette are made of these."""
