"""Recognise the kind of a part from its name in several languages."""

import re

_CHAIN = r"chain|cha[iî]ne|\w*kette\b|\bkjetting|\bcadena"
_NAMES = {
    "chain": _CHAIN,
    "release": (
        r"\brelease|\bacoustic rel|\blargu|\blargage|\bar[ -]?\d{3}|\bcdms ar\b|\b8242\b|\b866\b"
        r"|ausl[öo]se|utl[øo]se|\bliberador|\bsuelta"
    ),
    "connector": (
        r"shackle|\bshac|swivel|sling|\blink|pear|\bring|ringlet|miller|manille|[ée]merillon|maillon"
        r"|anneau|sch[äa]kel|wirbel|\bgrillete|giratorio|anilla|thimble|kausch|guardacabo"
    ),
    "anchor": (
        r"anchor|sinker|railway|\blest|\bancre|\bcorps.mort|dead ?weight|clump|\banker|grundgewicht"
        r"|\bancla|\bmuerto|\blastre"
    ),
    "rigid": (
        r"float|buoy|sphere|syntactic|instrument|sensor|logger|release|hardware|connector|shackle|swivel"
        r"|bou[ée]e|b[øo]ye|flotteur|capteur|auftrieb|boje|kugel|ger[äa]t|boya|flotador|esfera|sonde|terminal"
        r"|\bbody\b|cylinder"
    ),
    "line": (
        f"{_CHAIN}|"
        r"wire|\w*vaier\b|rope|\blines?\b|\bcable|c[âa]ble\b|cordage|filin|aussi[èe]re|\bbout\b|seil\b|seile\b|draht"
        r"|leine\b|\btau\b|trosse|kabel|\bcabo\b|cuerda|estacha|tether|hawser|\bwarp\b|nilspin|jetstr"
        r"|kevlar|aramid|twaron|technora|vectran|nylon|polyamid|dacron|polyester|polyprop|polysteel|danline"
        r"|dyneema|spectra|uhmwpe|\bhmpe|amsteel|plasma|tenex|samson|colmega|dynex|steelite|phillystran"
        r"|braid|strand|\b\d{1,2}x\d{1,2}\b(?!.*(?:\bgla|\bball|verre|vidrio|\bin\b|[\"\u2033]))|\bmanila\b|sisal|hemp\b|umbilical|\bcoax"
    ),
}
"""Patterns for part names in several languages, by kind."""

_HEAVY = 20.0  # N: maximum weight of connecting hardware, whatever its name
_LONG, _SLENDER = 3.0, 60.0
"""Minimum length [m] and minimum ratio of length to diameter of a line.

A piece that reaches both limits is a line, unless its name denotes a release or a connector.
"""

_LONGEST_PIECE = 20.0  # m: maximum length of a rigid piece


def is_called(name: str, *what: str) -> bool:
    """True if a name denotes a part of one of the given kinds.

    The kinds are release, chain, connector (swivels, links), anchor, line (wires, ropes, chains)
    and rigid (floats, instruments, fittings).
    """
    return any(re.search(_NAMES[each], name, re.I) for each in what)


def is_long(name: str, length: float, across: float) -> bool:
    """True if a piece must be a line because the piece is long and thin.

    Parameters
    ----------
    length, across : length and diameter of the piece [m]; an unknown diameter is 0
    """
    if is_called(name, "release", "connector"):
        return False
    slender = length >= _LONG and across > 0.0 and length >= _SLENDER * across
    return slender or length >= _LONGEST_PIECE


def role_of(name: str, buoyancy: float, *, fastener: bool = False) -> str:
    """Find the role of a rigid piece from its name and its net buoyancy.

    `buoyancy` is the net force in water, positive up [N]. `fastener` is whether the other program
    marks the piece as a fastener.
    """
    if is_called(name, "release"):
        return "release"
    if is_called(name, "connector") and buoyancy <= 0.0:
        return "connector"
    if buoyancy > 0.0:
        return "float"
    return "connector" if fastener and buoyancy > -_HEAVY else "instrument"


def size_in(name: str) -> float:
    """Find the diameter [m] in a name such as `8 mm wire` or `3/8" chain`; 0 if not found."""
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*mm\b", name, re.I)
    if found:
        return float(found[1].replace(",", ".")) / 1000.0
    found = re.search(r"(?:(\d+)[ -])?(\d+)/(\d+)", name)
    if found and int(found[3]):
        return (int(found[1] or 0) + int(found[2]) / int(found[3])) * 0.0254
    found = re.search(r"(\d+(?:[.,]\d+)?)\s*(?:\"|''|in\b|inch)", name, re.I)
    return float(found[1].replace(",", ".")) * 0.0254 if found else 0.0
