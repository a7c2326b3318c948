"""Attributes of the variables of a dataset: their frame, their quantity, their north.

A name is a custom of a program; the attributes are what the person who wrote the file says of it.
Where they name another frame or quantity than the name suggests, they are believed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

_FRAMES = re.compile(
    r"(?i)(velocity_?)?(coord(inate)?s?_?(sys(tem)?|frame|transform(ation)?)|(reference_?)?frame(_of_reference)?|"
    r"transform(ation)?)"
)
_TO_THE_EARTH = re.compile(r"earth|\benu\b|geographic|east|true")
_OTHER_FRAME = re.compile(r"beam|\binst|xyz|ship|head|vessel|body|vehicle|principal|stream|local")

_OTHER_DIRECTIONS = (
    r"\bbeam ?[1-5]?\b(?! ?(averag|mean|width))",
    r"\b(along|cross|across) ?(shore|shelf|slope|isobath|channel|stream|track|ship|axis|front)\b",
    r"\b(stream|span)wise\b|\bcross stream\b",
    r"\bprincipal\b|\b(major|minor) axis\b",
    r"\b(instrument|xyz|ship|vessel|vehicle|sensor|body|platform|glider|head) ?"
    r"(frame|coordinates?|axis|axes|reference)\b",
    r"\b(forward|starboard|portside|radial)\b",
    r"\b(instrument|ship|vessel|vehicle|platform|glider|float|drifter) relative\b",
    r"\brelative to (the )?(instrument|ship|vessel|vehicle|platform|glider|float|drifter|wind)\b",
    r"\b(anti|counter) ?clockwise\b|\bclockwise from (the )?(east|x)\b|\bmath(ematical)?\b",
    r"\b(adcp|adp|instrument|ship|vessel|platform|compass|sensor|glider) heading\b",
    r"\brotated\b(?!.*\b(to|into|in) (the )?(earth|true|geograph|enu|east))",
    r"\bgrid [xyij]\b|\b[xyij] (axis|direction) of the (model )?grid\b",
)
_OTHER_QUANTITIES = (
    r"\b(standard|std) ?(deviation|dev|error)\b|\bstd ?(err)?\b|\bstd?dev\b|\b(rms|variance)\b",
    r"\berror velocity\b|\buncertainty\b|\bnoise\b",
    r"\b(maxim(um|a)|minim(um|a)|percentile)\b",
    r"\banomal(y|ies)\b|\bpercent\b|\bquality\b|\bstatus\b|\bcorrelation\b|\bintensity\b",
    r"\b(winds?|ice|stokes|air)\b",
    r"\b(geostrophic|baroclinic|barotropic|ageostrophic)\b",
    r"\b(depth|vertically) ?(mean|averaged|integrated)\b",
    r"\b(transport|flux|shear|stress|acceleration|amplitude|phase|gradient|vorticity)\b",
    r"\b(ship|vessel|platform|bottom ?track|gps|drifter|buoy|glider)s? (velocity|speed|motion)\b",
    r"\bvelocity of (the |a )?(\w+ )?(ship|vessel|platform|drifter|buoy|glider)\b",
    r"\b(residual|difference|minus|bias)\b",
)
_NOT_A_CURRENT = [re.compile(text) for text in _OTHER_DIRECTIONS + _OTHER_QUANTITIES]

_ROTATION = re.compile(
    r"(?i)((coord\w*|grid|frame|axis|axes|velocity)_)?rotation(_angle)?(_deg(rees)?)?"
)
_SPREADS = re.compile(r"\b(maximum|minimum|range|standard_deviation|variance|sum)\b")
_OPPOSED = {
    "east": (r"\b(north|south|west)wards?\b|\b(meridional|v)\b", r"\beast|\b(zonal|u)\b"),
    "north": (r"\b(east|south|west)wards?\b|\b(zonal|u)\b", r"\bnorth|\b(meridional|v)\b"),
    "up": (r"\bdownwards?\b", r"\bup"),
}
"""Words that speak against a way, and words for it, with which the others may stand."""

_MAGNETIC = re.compile(r"\bmag(netic)?\b")
_DECLINATION = re.compile(r"\bdeclination\b")
_UNTURNED = re.compile(
    r"(?i)(magnetic_?)?(declination|variation|deviation)_?(is_?)?(applied|corrected)"
)
_MAGNETIC_NORTH = re.compile(r"\bmagnetic (north|east)\b|\bdeg(rees)? magnetic\b")
_NO = ("0", "0.0", "no", "false", "n", "none", "not applied")
_DATUM = re.compile(r"(?i)(\w+_)?(north|datum|reference|frame|coord\w*_?sys\w*)(_\w+)?")
_UNCORRECTED = re.compile(
    r"\b(not|un|no|without)\b.{0,30}(correct|appl|declination|variation)|\buncorrected\b"
)
_CORRECTED = re.compile(
    r"correct|appl(y|ied)|declination|variation|deviation|\b(to|into) (the )?true\b"
)
_TOWARD = re.compile(r"\bto direction\b|\btowards?\b|\bflow(s|ing)? to\b|\bgoing to\b|\bset\b")
_FROM = re.compile(r"\bfrom direction\b|\bdirection from\b|\bcom(es|ing) from\b|\bfrom which\b")


def words_of(variable: xr.DataArray, *attributes: str) -> str:
    """Return some attributes of a variable as plain lower-case words, one blank between them."""
    told = " ".join(str(variable.attrs.get(name, "")) for name in attributes)
    return re.sub(r"[\W_]+", " ", told.lower()).strip()


def not_a_current(variable: xr.DataArray) -> str | None:
    """Return why a variable is no velocity of water to the east, north or up; None if it may be.

    Only what it says of itself counts: its long name, standard name, frame and cell methods.
    """
    own = words_of(variable, "long_name", "standard_name")
    if part_in_words(own) or any(pattern.search(own) for pattern in _NOT_A_CURRENT):
        said = variable.attrs.get("long_name") or variable.attrs.get("standard_name")
        return f"is `{said}`, which is not a current to the east and north"
    methods = str(variable.attrs.get("cell_methods", ""))
    if _SPREADS.search(methods):
        return f"is `cell_methods: {methods}`, which is not a measured or modelled current"
    if variable.encoding.get("scale_factor") == 0:
        return "has `scale_factor: 0`, which makes every value the same"
    return other_frame(variable.attrs) or part_in_texts(variable.attrs)


def another_way(variable: xr.DataArray, way: str) -> str | None:
    """Return why a velocity is not ``"east"``, ``"north"`` or ``"up"``, by its long name."""
    against, for_it = _OPPOSED[way]
    own = words_of(variable, "long_name")
    if re.search(against, own) and not re.search(for_it, own):
        return f"is taken as {way}ward, and says `{variable.attrs['long_name']}`"
    return None


def other_frame(attributes: Mapping[Any, Any]) -> str | None:
    """Return why a current is not to the east and north, by the coordinate system that a dataset or
    a variable gives; None if it may be.
    """
    for name in filter(_FRAMES.fullmatch, map(str, attributes)):
        frame = str(attributes[name]).lower()
        if _OTHER_FRAME.search(frame) and not _TO_THE_EARTH.search(frame):
            said = f"is in other coordinates, `{name}: {attributes[name]}`"
            return f"{said}, not to the east and north; rotate it to the earth's first"
    for name in filter(_ROTATION.fullmatch, map(str, attributes)):
        if str(attributes[name]).strip().lower() not in _NO:
            said = f"is rotated, `{name}: {attributes[name]}`"
            return f"{said}, not to the east and north; rotate it back first"
    return None


def is_magnetic(variable: xr.DataArray, dataset: Mapping[Any, Any] = MappingProxyType({})) -> bool:
    """Return whether a velocity or direction is relative to magnetic north by its own words."""
    if _MAGNETIC.search(re.sub(r"_", " ", str(variable.name).lower())):
        return True
    own = words_of(variable, "long_name", "standard_name", "reference_datum", "units", "reference")
    if _MAGNETIC.search(own) and (_UNCORRECTED.search(own) or not _CORRECTED.search(own)):
        return True
    if any(_says_so(variable.attrs.get(name), _MAGNETIC) for name in ("comment", "note", "notes")):
        return True
    return is_magnetic_by(variable.attrs) or is_magnetic_by(dataset)


def is_magnetic_by(attributes: Mapping[Any, Any]) -> bool:
    """Return whether attributes say that directions are relative to magnetic north."""
    for name, said in attributes.items():
        if _UNTURNED.fullmatch(str(name)):
            counted = str(said).strip().lower() in _NO
        else:
            counted = _says_so(said, _MAGNETIC if _DATUM.fullmatch(str(name)) else _MAGNETIC_NORTH)
        if counted:
            return True
    return False


def _says_so(said: Any, magnetic: re.Pattern[str]) -> bool:
    """Return whether a text speaks of magnetic north in a sentence, and corrects it in none."""
    if not isinstance(said, str):
        return False
    sentences = [" ".join(re.split(r"[_\W]+", one)) for one in _SENTENCE.split(said.lower())]
    told = [one for one in sentences if _MAGNETIC.search(one) or _DECLINATION.search(one)]
    if any(_UNCORRECTED.search(one) for one in told):
        return True
    return not any(map(_CORRECTED.search, told)) and any(map(magnetic.search, told))


def way_of(variable: xr.DataArray, *attributes: str) -> str | None:
    """Return whether a direction is where the current flows ``"to"`` or comes ``"from"``.

    The attributes that count say so; its names and its comment where none is given.
    """
    own = words_of(variable, *(attributes or ("long_name", "standard_name", "comment")))
    toward, origin = _TOWARD.search(own), _FROM.search(own)
    if bool(toward) == bool(origin):
        return None
    return "to" if toward else "from"


_FILTERED = (
    r"\b(low|high|band) ?pass(ed)?\b|\blanczos\b|\bbutterworth\b|\bdemerliac\b|"
    r"\b(godin|doodson|pl ?(33|64|66)\w*) ?(tidal )?filter|"
    r"\b(2[5-9]|[3-9]\d) ?(h|hr|hours?|hourly) (running |moving )?(means?|average[ds]?|filter)\b"
)
_WITHOUT_TIDES = (
    r"\bde ?tided\b|\bsub ?tidal\b|\bnon ?tidal\b|"
    r"\btid(al|es?)( \w+){0,2} (removed|subtracted|filtered out)\b|"
    r"\b(remov\w+|subtract\w+|without|minus|excluding) (the )?tid(al|es?)\b"
)
_TIDES_ALONE = (
    r"\b(only|purely|just) (the )?tid(al|es?)\b|\btid(al|es?)( \w+){0,2} (only|alone)\b|"
    r"\btidal (constituents?|harmonics?|predictions?|ellips\w+)\b|\bpredicted tid(al|es?)\b|"
    r"\b(baroclinic|barotropic|internal) tides?\b|\bharmonic (constituents?|predictions?)\b|"
    r"\b(predict\w+|reconstruct\w+)( \w+){0,3} tid(al|es?)\b|"
    r"\b(tid(al|es?)( \w+){0,2}|t tide|utide) (predict|reconstruct|hindcast)\w*\b"
)
_LONG_MEANS = (
    r"\bclimatological (mean|average|current|velocit\w+|month|year|value)\w*\b|"
    r"\b(mean|monthly|annual|seasonal|daily) climatolog(y|ies)\b|\bclimatology of\b|"
    r"\b(annual|seasonal|decadal|long term|multi ?year) (mean|average)\b|"
    r"\b(mean|averaged?) over \d+ years\b|\b\d+ years? (mean|average)\b|"
    r"\bsubtract\w*( \w+){0,4} mean\b|\bmean (was |is )?subtracted\b|"
    r"\b(means?|averaged?) over (19|20)\d\d( to)? (19|20)\d\d\b|\b(time|record) mean\b|"
    r"\b(y(day|mon|seas)|tim|multi ?year)mean\b|\b(day|mon|seas|year|tim)(max|min|std|pctl)\b"
)
_OTHER_FRAMES = re.compile(
    r"\brelative to (the |a )?(moving )?"
    r"(instrument|ship|vessel|vehicle|platform|glider|float|drifter)\b|"
    r"\b(ship|vessel|glider|platform|vehicle|drifter) relative\b|\bshear only\b|"
    r"(?<!from )\b(beam|instrument|ship|xyz) (frame|coordinates?)\b"
    r"(?!.*\b(earth|enu|true|transform\w*|convert\w*)\b)|\bunreferenced\b|\brotated\b(?!.*\b(earth|true|geograph\w*|enu|east|declination|"
    r"magnetic|variation|back)\b)"
)
_IN_TEXTS = re.compile("|".join((_FILTERED, _WITHOUT_TIDES, _TIDES_ALONE, _LONG_MEANS)))
_IN_NAMES = re.compile(
    r"\bclimatolog\w+\b|\b(perturbation|fluctuat\w+|turbulen\w+|orbital|ekman|(near )?inertial|"
    r"increments?|tendency|trend|spread|skewness|kurtosis|normali[sz]ed|non ?dimensional|squared|"
    r"logarithm|displacement|eof|mode \d+|counts?|number of|eddy)\b|"
    r"\brelative to \d+|\bof sound\b"
)
_IN_TITLES = re.compile(
    r"\bclimatolog(y|ies)\b|"
    r"\b(residual|geostrophic|ekman|stokes|baroclinic|barotropic) "
    r"(currents?|velocit\w+|flow|drift|profiles?)\b|"
    r"\b(percent|quant)iles?\b|\banomal(y|ies)\b|\b(tpxo|fes ?20|eot ?[12]|got ?4)\w*\b|"
    r"\b(standard deviation|std|variance|rms|maxim(a|um)|minim(a|um)) (of|current|velocit|speed)"
)
_REMARKABLE = (
    (
        r"\b(daily|weekly|monthly|seasonal|annual|yearly) (mean|average|current)[ds]?\b|"
        r"\b(day|mon|seas|year)(mean|avg)\b",
        "the peaks are higher than the means",
    ),
    (
        r"\breturn (values?|periods?|levels?)\b|\bextreme (values?|currents?|profiles?)\b|"
        r"\b\d+ ?(year|yr)s? (return|extreme|storm|event|current)",
        "extremes by statistics are no currents of one time",
    ),
)
"""Words of a text, and what is said of a current that is read all the same."""

_REMARKABLE_IN_TITLES = (
    *_REMARKABLE,
    (r"\b(mean|averaged?) (current|velocit)\w*\b", "the peaks are higher than the means"),
    (
        r"^(the )?tid(al|es?)\b"
        r"(?!.*\b(obser[v]|measur|adcp|adp|moor|meter|record|channel|inlet)\w*)",
        "where it is the tide alone, the rest of the current is missing",
    ),
)
_TIDAL = re.compile(r"\btid(al|es?)\b")
_WITH_TIDES = re.compile(r"\b(total|includ\w+|with|and|plus|waves?|not removed)\b")

_TEXTS = re.compile(
    r"(?i)title|summary|abstract|comments?|notes?|description|history|(data_)?processing(_\w+)?|"
    r"source|keywords|id|(\w+_)?filter(ing|ed|s)?(_\w+)?|data_type|subject|purpose"
)
_TITLES = re.compile(r"(?i)title|summary|abstract|description|data_type|subject|purpose")
_SENTENCE = re.compile(r"\.(?!\d)|[;()\n]")
_OF_OTHERS = re.compile(
    r"\b(temperatures?|salinit\w+|pressures?|sea level|elevations?|conductivit\w+|headings?|"
    r"pitch|roll|not|no|never|against|before|elsewhere|see|also|forc\w+|boundar(y|ies)|depths?|heights?)\b"
)
"""What speaks of another variable, or against itself."""

_OVER_YEARS = re.compile(r"\b(within|over) (years|days)\b")


def part_in_words(own: str) -> str | None:
    """Return the words by which a quantity's name is a part of the current; None without.

    Its own names are plain lower-case words, one blank between them.
    """
    found = _IN_TEXTS.search(own) or _IN_NAMES.search(own)
    if found is None and not _WITH_TIDES.search(own):
        found = _TIDAL.search(own)
    return None if found is None else found.group()


def part_in_texts(attributes: Mapping[Any, Any]) -> str | None:
    """Return why a current is a part of the whole, by what its texts say; None if it may be it.

    They are those of a dataset or of a variable. A sentence that denies it, or speaks of another
    variable too, does not count.
    """
    for name, words, said in _sentences(attributes):
        if _OTHER_FRAMES.search(words):
            return f"is in other coordinates by its {name}: {said}"
        found = None if name == "keywords" else _IN_TEXTS.search(words)
        if found is None and _TITLES.fullmatch(name):
            found = _IN_TITLES.search(words)
        if found is not None:
            return f"is not the whole current by its {name}: {said}"
    methods = str(attributes.get("cell_methods", ""))
    if _OVER_YEARS.search(methods):
        return f"is a mean of many years, `cell_methods: {methods}`, not a current at one time"
    return None


def remarks_in_texts(attributes: Mapping[Any, Any]) -> list[str]:
    """Return what texts say that a person should know of a current that is read.

    A title or a history counts wherever it says so, any other text where a sentence begins with it.
    """
    told = []
    for name, words, said in _sentences(attributes):
        titled = _TITLES.fullmatch(name) or name == "history"
        for pattern, meaning in _REMARKABLE_IN_TITLES if titled else _REMARKABLE:
            if (re.search if titled else re.match)(pattern, words):
                told.append(f"its {name} says `{said}`: {meaning}")
                break
        if name == "keywords" and (_IN_TEXTS.search(words) or _IN_TITLES.search(words)):
            told.append(f"its keywords say `{said}`: a part of the current, or the whole?")
    return told


def _sentences(attributes: Mapping[Any, Any]) -> Iterator[tuple[str, str, str]]:
    """Yield the name, the plain words and the text of the sentences that speak of the current."""
    for name, said in attributes.items():
        if isinstance(said, str) and _TEXTS.fullmatch(str(name)):
            for sentence in _SENTENCE.split(said.lower()):
                words = re.sub(r"[\W_]+", " ", sentence).strip()
                if not _OF_OTHERS.search(words):
                    yield str(name), words, said.strip()[:80]


_LOCAL = re.compile(
    r"(?i)\butc ?[+-] ?0?[1-9]|(?-i:\b(CES?T|EDT|PDT|JST|BST|MEZ|MESZ)\b)|"
    r"\b(local (\w+ )?times?|times? (is|are) (in )?local|times? in local)\b|"
    r"\b(daylight|standard|summer|winter) time\b(?! ?(series|scale|step))|"
    r"\btimes?\W+((is|are|zone|in)\W+)*(c?e[sd]t|cet|bst|[cmp][sd]t|mesz?|mez|jst|hst|aest)\b"
)
_IN_UTC = re.compile(r"(?i)\b(convert|correct|transform|shift)\w*\b|\bto (utc|gmt)\b|\bnot\b")
_UPWARDS = re.compile(
    r"(?i)\b(depths?|levels?|bins?)\b.*"
    r"\b(heights?|(above|up from|upwards? from) (the )?(sea ?bed|sea ?floor|bottom))\b"
)


def is_local(text: str) -> bool:
    """Return whether a text says that times are of another zone than UTC."""
    return bool(_LOCAL.search(text)) and not _IN_UTC.search(text)


def refused_by_comments(comments: Sequence[str], *, magnetic: bool) -> str | None:
    """Return why a table is not of the current, by the comments above it; None if it may be.

    It is `magnetic` where its headings say that it is relative to magnetic north.
    """
    said = {"comment": "\n".join(comments)}
    if not magnetic and is_magnetic_by(said):
        return "is relative to magnetic north by its comment: write `toward[deg magnetic]`"
    return part_in_texts(said)


def remarks_in_comments(comments: Sequence[str]) -> list[str]:
    """Return what the comments above a table say that a person should know."""
    notices = remarks_in_texts({"comment": "\n".join(comments)})
    for comment in comments:
        if is_local(comment):
            notices.append(f"its comment says `{comment[:80]}`: the times are taken as UTC")
        if _UPWARDS.search(comment):
            notices.append(f"its comment says `{comment[:80]}`: the depths are taken as depths")
    return notices
