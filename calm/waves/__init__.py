"""Effect of waves on a mooring: linear tensions and motions about its static equilibrium."""
