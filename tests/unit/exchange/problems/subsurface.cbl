/* A sub-surface mooring in sheared current, solved by WHOI Cable 3.12 as it stands */
#define INCH 0.0254
#define WIRE_MASS(weight) ((weight) * 1.25 / 9.81)

Problem Description
    title = "Sub-surface mooring"
    type = subsurface

Analysis Parameters
    static-solution = relaxation
    static-initial-guess = shooting
    static-iterations = 500
    static-outer-iterations = 500
    static-tolerance = 1e-5
    static-relaxation = 0.1
    static-outer-tolerance = 1e-4
    duration = 10
    time-step = 0.1

Environment
    rho = 1027
    gravity = 9.81
    depth = 300
    x-current = 0.8 * exp(-0.01*H)
    forcing-method = morison
    input-type = regular
    x-wave = (1.0, 8.0, 0.0)

Buoys
    float   type = sphere   d = 41*INCH   m = 250   Cdn = 0.65

Anchors
    clump   color = red

Connectors
    shackle   d = 0.08   wet = 12.0   m = 1.5   Cdn = 0.5
    logger    d = 0.12   wet = 30.0   m = 5.0   Cdn = 1.0
    release   d = 0.4    wet = 350.0  m = 60    Cdn = 1.0

Materials
    wire_1/4in
        EA = 3.3e6   EI = 0.5   GJ = 0.1   m = WIRE_MASS(1.2)   wet = 1.2
        d = 0.25*INCH   Cdn = 1.5   Cdt = 0.01
    chain_1/2in
        EA = 5.0e7   EI = 0.01   m = 3.7   wet = 31.6   d = 0.045   Cdn = 0.55   Cdt = 0.05

Layout
    terminal = {
        anchor = clump
    }
    segment = {
        length = 5
        material = chain_1/2in
        nodes = (11, 1.0)
    }
    connector = release
    segment = {
        length = 200
        material = wire_1/4in
        nodes = (101, 0.5) (201, 0.5)
        attachments = logger : (51, 251)
    }
    connector = shackle
    segment = {
        length = 40
        material = wire_1/4in
        nodes = (41, 1.0)
        attachments = logger : [11, 10, 31]
    }
    terminal = {
        buoy = float
    }

End
