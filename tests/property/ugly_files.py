"""Mooring files as people write them, none of them tidy: what an edit has to leave alone."""

MIXED = """\
# A line in both manners, with comments wherever one may stand.

name:   'Ligne d''été'      # kept as it is
description: >
  folded text
  of two lines

  and a third
position: {latitude: 48.3 deg,   longitude: -5.2 deg }

# the water
environment:
    depth: 1100 m             # charted
    # a comment between keys
    density: {columns: [depth m, density kg/m^3], rows: [[0, 1024], [500, 1028]]}
    current:
        columns: [depth m, speed m/s, toward deg]
        rows:
            # the surface
            - [0, 0.80, 90]     # measured
            - [200, "0.35", 80]

            - - 1100
              - 0.05
              - 60


line:   # top to bottom

    # the float, borrowed
    - {use: ball, label: "flotteur n° 1, haut"}   # 	a tab in here

    # --- upper part ---

    - use: rope
      length: 480 m   # cut in May
      # the instruments
      clamps:
        - {use: meter, at: 20 m}
        # - {use: meter, at: 30 m}
        - use: meter
          at: 120 m
          # deeper than the item
    - {use: rope, length: fit,
       top_depth: 105 m,   # above the thermocline
       label: 'l''autre'}
    -
      use: meter
      label: größer
      note: |
        two lines
          of literal text

    # directly above
    # in two lines
    - {use: dead,
    label: anchor}
    # below the last, in its column

# the end
components: { }
checks:
    maximum_knockdown: 50 m
# last words"""

CRLF = """\
name: Windows\r
environment:\r
  depth: 300 m\r
  current: {speed: 0.5 m/s, toward: 90 deg}  # uniform\r
\r
line:\r
- {use: ball}\r
# the rope\r
- use: rope\r
  length: 200 m\r
  clamps:\r
  - {use: meter, at: 5 m}\r
  # second\r
  - {use: meter, at: 9 m}\r
\r
- {use: dead}  # anchor\r
solver: {drag: reynolds}\r
"""

BRACKETS = """\
{name: Braces,
 "environment": {"depth": "300 m", "current": {"speed":"0.5 m/s", "toward":"90 deg"}},
 line: [
   # the float
   {use: ball, label: top},   # bought in 2019
   {use: rope,
    length: 200 m, clamps: [{use: meter, at: 5 m}, {use: meter, at: 6 m,}]},

   # below a blank line
   {use: meter, label: "a, b"}, # meter
   {use: dead}
 ]
}
"""

INLINE = """\
\ufeffname: Inline
environment: {depth: 300 m}
line: [{use: ball}, {use: rope, length: 20 m, label}, # a rope
       {use: meter, label: },
       {use: dead , label: 深い}]   # end
"""

BARE = """\
line:
-   use: ball
    label: top
-   use: rope
    length: 20 m
    clamps: [
      {use: meter, at: 1 m},   # one
      {use: meter, at: 2 m},   # two
    ]
-   shackle-13
-
-   {use: dead, label: "quoted \\
        over two lines"}
environment:
"""

UGLY = {
    "mixed": MIXED,
    "crlf": CRLF,
    "brackets": BRACKETS,
    "inline": INLINE,
    "bare": BARE,
    "bare crlf": BARE.replace("\n", "\r\n"),
}
