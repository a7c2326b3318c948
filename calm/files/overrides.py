"""What an override on the line makes void in the definition it overlays.

Some figures are alternatives: a body gives its drag as `kn` or as `drag_area` with `cd`; a net
force is given, or follows from mass and volume. An override that gives one alternative drops the
others; whatever it does not contradict stays.
"""

from __future__ import annotations

from collections.abc import Set

from calm.files.components import RIGID_KINDS
from calm.files.rigid import DRAG_FORMS

_DRAG_KEYS = frozenset(key for form in DRAG_FORMS for key in form) | {"kt"}


def contradicted(kind: str, base: Set[str], override: Set[str]) -> frozenset[str]:
    """The keys of a definition that an override of it makes void.

    Parameters
    ----------
    kind : str
        Of the definition.
    base, override : set of str
        The keys that the definition and the override give.

    Notes
    -----
    ================ =========================== ==============================================
    kind             override gives              dropped from the definition
    ================ =========================== ==============================================
    body             a drag in another form      its own form, with the `kt` that went with it
    rigid            `buoyancy`                  `volume`
    rigid            `mass` or `volume`, both    `buoyancy`, which then follows from them
                     being known
    cable            `weight` or `buoyancy`      the other of the two
    cable            `density`, or `mass` where  `weight`, `buoyancy`, which then follow
                     a density is known
    cable            `stiffness`                 `elongation`, `permanent_elongation`
    cable            `elongation`                `stiffness`
    chain, anchor    `mass` or `density`         `weight`, which then follows
    ================ =========================== ==============================================
    """
    known = base | override
    void: set[str] = set()
    if kind == "body":
        for form in DRAG_FORMS:
            if override & set(form) and not base & set(form):
                void = set(_DRAG_KEYS)
    if kind in RIGID_KINDS:
        if "buoyancy" in override:
            void.add("volume")
        elif known >= {"mass", "volume"} and override & {"mass", "volume"}:
            void.add("buoyancy")
    elif kind == "cable":
        if override & {"weight", "buoyancy"} or (
            known >= {"mass", "density"} and override & {"mass", "density"}
        ):
            void |= {"weight", "buoyancy"}
        if "stiffness" in override:
            void |= {"elongation", "permanent_elongation"}
        if "elongation" in override:
            void.add("stiffness")
    elif override & {"mass", "density"}:
        void.add("weight")
    return frozenset(void - override)
