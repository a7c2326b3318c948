/* A surface mooring with a hull given by its diameters, solved by WHOI Cable 3.12 as it stands */
Problem Description
    title = "Surface mooring"
    type = surface

Analysis Parameters
    static-solution = relaxation
    static-initial-guess = shooting
    static-iterations = 500
    static-outer-iterations = 500
    static-tolerance = 1e-4
    static-relaxation = 0.1
    static-outer-tolerance = 1e-3
    duration = 10
    time-step = 0.1

Environment
    rho = 1025
    gravity = 9.81
    depth = 200
    x-current = (0, 0.6) (50, 0.4) (200, 0.1)

Buoys
    discus  type = axisymmetric   m = 600
            diameters = (0, 0.5) (0.3, 1.6) (0.6, 2.0) (1.0, 2.0)
            Cdn = 1.0

Anchors
    clump

Materials
    chain   EA = 5.0e7   EI = 0.01   m = 8.0    wet = 68.0   d = 0.066   Cdn = 0.5   Cdt = 0.006
    wire    EA = 4.7e6   EI = 0.1    m = 0.32   wet = 2.64   d = 0.01    Cdn = 1.5   Cdt = 0.01

Layout
    terminal = { anchor = clump }
    segment = { length = 20  material = chain  nodes = (81, 1.0) }
    segment = { length = 181 material = wire   nodes = (363, 1.0) }
    terminal = { buoy = discus }
End
