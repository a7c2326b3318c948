/* A towed body, solved by WHOI Cable 3.12 as it stands */
Problem Description
    title = "Tow"
    type = towing

Analysis Parameters
    static-solution = shooting
    static-iterations = 2000
    static-relaxation = 0.1
    tolerance = 1e-6
    duration = 10
    time-step = 0.1

Environment
    rho = 1025
    gravity = 9.81

Buoys
    vessel  type = ship
    sled    type = sphere   d = 0.736   m = 1135   buoyancy = 4448   Cdn = 0.77

Materials
    cable   d = 0.0173   m = 1.12   wet = 8.89   Cdn = 1.5   Cdt = 0.01   EA = 1.2717e7   EI = 0.01

Layout
    terminal = { buoy = sled }
    segment = { length = 500  material = cable  nodes = (501, 1.0) }
    terminal = { buoy = vessel   x-speed = 0.514*4   y-speed = 0 }
End
