"""What waves add to a mooring: linear tensions and motions about its static equilibrium."""
