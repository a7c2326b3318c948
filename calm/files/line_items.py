"""Read the `line` of a mooring file: expand items into pieces, apply overrides, resolve labels."""

import math
from collections.abc import Iterable
from dataclasses import replace
from itertools import accumulate
from typing import TYPE_CHECKING, Any, TypeVar

from calm.errors import LONGEST_TEXT, about_quantity, shown, unknown
from calm.files import components, item_keys
from calm.files.catalogue import Assembly, Catalogue, CatalogueEntry, Defined, define
from calm.files.check_limits import LENIENT_IF_GREATER, LENIENT_IF_LESS, LimitKey
from calm.files.components import FLEXIBLE_KINDS, KINDS, Anchor, Component, Flexible, Outline
from calm.files.definition import IN_AIR, LENGTH, POSITIVE_LENGTH, QuantityField, quantity_of
from calm.files.item_keys import ASSEMBLY_FIGURES, MOST_PIECES
from calm.files.pieces import Clamp, Piece, Place, parts_of, placed, unplanned
from calm.files.planned_depth import named_depth
from calm.files.rigid import Profiler, Rigid
from calm.files.yaml_document import SourceMapping, unknown_key, validate
from calm.units import QuantityError

if TYPE_CHECKING:
    from calm.files.catalogue_search import WordIndex

_COUNT = QuantityField("number", at_least=1, at_most=MOST_PIECES)
_ITEM_KEYS = frozenset(item_keys.ItemKeys.model_fields)
_ASSEMBLY_KEYS = frozenset({"use", "label", "count", "serial"})
_NUMBERED = (("instrument", "release"), ("float",))
"""Roles of those parts of an assembly that have serial numbers, in two groups.

The second group is used if the assembly has no part with a role in the first group.
"""
_SOURCE_KEYS = frozenset({"source", "sources"})
_CLAMP_KEYS = frozenset(item_keys.ClampKeys.model_fields)
_Part = TypeVar("_Part", Piece, Clamp)
_WORDS = {"at": "place", "top_depth": "top depth", "body_depth": "body depth"}


class LineReader:
    """Reader that expands the items of a line into pieces.

    Mistakes are recorded in the top-level mapping `top`, and remarks in `notices`.
    """

    def __init__(
        self,
        catalogue: Catalogue,
        top: SourceMapping,
        notices: list[str],
        *,
        towed: bool = False,
        in_air: bool = False,
    ) -> None:
        self._catalogue = catalogue
        self._problems = top.problems
        self._notices = notices
        self.looser: list[LimitKey] = []
        self._towed = towed
        self._in_air = in_air
        self._defined: dict[str, Defined | None] = {}
        self._assemblies: dict[str, tuple[Piece, ...]] = {}
        self._open: list[str] = []
        self._index: WordIndex | None = None

    def check(self, ids: Iterable[str]) -> None:
        """Validate the definitions with the given ids, even if the line does not use them."""
        for id in ids:
            entry = self._catalogue.entry(id)
            if entry is not None:
                section = entry.section.into(self._problems)
                definition = self._defined[id] = self._define(entry, section)
                if isinstance(definition, Assembly):
                    self._assembly(entry, section)

    def read(self, section: SourceMapping, key: str) -> tuple[Piece, ...]:
        """Read the list of items under a key, and return the pieces that the items produce.

        Items with mistakes are skipped, and their mistakes are recorded.
        """
        pieces: list[Piece] = []
        items = self._items(section, key)
        for number, item in enumerate(items, 1):
            pieces += self._item(item)
            if max(number, len(pieces)) > MOST_PIECES:
                item.refuse((), f"the line has more than {MOST_PIECES} pieces")
                return ()
        return tuple(pieces)

    def _items(self, section: SourceMapping, key: str) -> list[SourceMapping]:
        found = section.data[key]
        if not isinstance(found, (list, tuple)):
            section.refuse((key,), f"`{key}` must be a list of items, as `{key}: [{{use: sbe37}}]`")
            return []
        items = []
        for i, item in enumerate(found[: MOST_PIECES + 1]):
            if isinstance(item, dict):
                items.append(section.child(key, i))
            else:
                use = shown(item).removeprefix("use ") or "…"
                message = f"`{shown(item)}` is not an item; write `{{use: {use}}}`"
                section.refuse((key, i), message)
        return items

    def _item(self, item: SourceMapping) -> tuple[Piece, ...]:
        count = self._count(item)
        entry = self._entry(item)
        definition = self._definition(entry, item, _ITEM_KEYS) if entry else None
        items = (definition.items or 1) if isinstance(definition, Component) else None
        item_keys.check_counted(item, count, items)
        if entry is None or definition is None:
            self._check_without_kind(item, judged=entry is not None)
            self._clamps(item, None)
            return ()
        if isinstance(definition, Assembly):
            once = self._filled(self._assembly(entry, item), definition, entry, item)
            once = self._with_serials(once, item, count)
        else:
            once = (self._piece(definition, item),)
        if len(once) * count > MOST_PIECES:
            item.refuse(("count",), f"a count of {count} makes more than {MOST_PIECES} pieces")
            return ()
        if count > 1:  # several pieces cannot have the same planned depth
            once = tuple(map(unplanned, once))
        number = item.location[-1]
        assert isinstance(number, int)  # the index in a list
        first = 0 if isinstance(definition, Assembly) else -1
        return tuple(
            placed(piece, Place(number, repeat, part))
            for repeat in range(count)
            for part, piece in enumerate(once, first)
        )

    def _check_without_kind(self, item: SourceMapping, *, judged: bool) -> None:
        """Check the keys of an item whose component is unknown or has mistakes.

        If `judged` is true, all keys but `length` were already checked with the definition.
        """
        if item.data.get("length", "fit") != "fit":
            self._quantity(item, "length", POSITIVE_LENGTH, "")
        for key in () if judged else item.data.keys() - _ITEM_KEYS - {"kind"}:
            fields = [kind.model_fields[key] for kind in KINDS.values() if key in kind.model_fields]
            quantities = {quantity_of(field) for field in fields}
            if not fields:
                known = {name for kind in KINDS.values() for name in kind.model_fields} | _ITEM_KEYS
                message = unknown_key(key, sorted(known))
                item.refuse((key,), message, key=True)
            elif len({each and each.dimension for each in quantities}) == 1:
                for quantity in filter(None, [quantities.pop()]):
                    self._quantity(item, key, QuantityField(quantity.dimension), "")

    def _piece(self, component: Component, item: SourceMapping) -> Piece:
        length: float | None
        load = 0.0
        if isinstance(component, Profiler):
            message = "a profiler must be among the `clamps` of its wire"
            item.refuse(("use",), message)
        if not isinstance(component, Flexible):
            length = component.length
        elif item.data.get("length") == "fit":
            length = None
        elif "length_at" in item.data:
            length, load = self._measured(item, component)
        else:
            need = "every cable or chain needs a length"
            length = self._quantity(item, "length", POSITIVE_LENGTH, need) or math.nan
        if "length_at" in item.data and not isinstance(component, Flexible):
            message = (
                "`length_at` is for cables and chains; this piece has the length given in its "
                "definition"
            )
            item.refuse(("length_at",), message, key=True)
        elif "length" in item.data and "length_at" in item.data:
            message = "gives both `length` and `length_at`, which exclude each other"
            item.refuse(("length_at",), message, key=True)
        fit_depth = self._fit_depth(item, fits=length is None)
        clamps = self._clamps(item, length)
        place = item.problem((), "")
        use = item.data["use"]
        self._notice_unknown_mass(use, component)
        return Piece(
            index=0,
            use=use,
            label=self._label(item),
            component=component,
            length=length,
            fit_top_depth=None if self._towed else fit_depth,
            clamps=clamps,
            line=place.line,
            column=place.column,
            place=Place(0),
            fit_body_depth=fit_depth if self._towed else None,
            equipment=self._equipment(item, component, clamped=False),
            measured_load=load,
            named=self._named(item),
        )

    def _measured(self, item: SourceMapping, component: Flexible) -> tuple[float, float]:
        """Return the unstretched length [m] of a cable, and the load [N] in `length_at`.

        The file gives the length under this load.
        """
        if not isinstance(item.data["length_at"], dict):
            example = "{load: 2 kN, length: 480 m}"
            item.refuse(("length_at",), f"`length_at` must have the form `{example}`")
            return math.nan, 0.0
        measured = validate(item_keys.LengthAt, item.child("length_at"))
        if measured is None:
            return math.nan, 0.0
        breaking = component.breaking_load
        if breaking is not None and measured.load > breaking:
            message = f"`load` must not exceed the breaking load of {breaking:g} N"
            item.refuse(("length_at", "load"), message)
        return measured.length / (1.0 + component.strain_under(measured.load)), measured.load

    def _fit_depth(self, item: SourceMapping, *, fits: bool) -> float | None:
        """Return the depth [m] that determines the length of a piece that is cut to fit.

        The depth is that of the top of a mooring, or of the lower end of the piece in a tow.
        """
        key, foreign, home = ("top_depth", "body_depth", "tows")
        if self._towed:
            key, foreign, home = ("body_depth", "top_depth", "moorings")
        if foreign in item.data:
            message = f"`{foreign}` is only for {home}; use `{key}` here"
            item.refuse((foreign,), message, key=True)
        if fits and (key in item.data or foreign not in item.data):
            # depths count from the surface; a tow in air may end above it
            kind = QuantityField("length") if self._in_air else LENGTH
            return self._quantity(item, key, kind, "`length: fit` needs a depth")
        if key in item.data:
            item.refuse((key,), f"`{key}` is only for `length: fit`", key=True)
        return None

    def _notice_unknown_mass(self, use: str, component: Component) -> None:
        if self._in_air and component.mass is None and component.displaced_volume is None:
            notice = f"{use}: the mass is unknown; the net force in water is used as weight in air"
            self._notices += [notice] * (notice not in self._notices)

    def _clamps(self, item: SourceMapping, length: float | None) -> tuple[Clamp, ...]:
        clamps: list[Clamp] = []
        for clamp in self._items(item, "clamps") if "clamps" in item.data else ():
            entry = self._entry(clamp)
            component = self._definition(entry, clamp, _CLAMP_KEYS) if entry else None
            at: float | None = 0.0
            if entry is None or entry.section.data.get("kind") != "profiler":
                at = self._quantity(clamp, "at", LENGTH, "the distance from the top of the piece")
            elif "at" in clamp.data:
                message = "a profiler must not have `at`, since it travels `between` two stops"
                clamp.refuse(("at",), message, key=True)
            if at is not None and length is not None and at > length:
                message = (
                    f"`at: {shown(clamp.data['at'])}` is beyond the end of the piece, which is "
                    f"{length:g} m long"
                )
                clamp.refuse(("at",), message)
            if isinstance(component, Rigid) and at is not None:
                self._notice_unknown_mass(clamp.data["use"], component)
                where = Place(0, clamp=len(clamps))
                own = self._equipment(clamp, component, clamped=True)
                label = self._label(clamp)
                use, named = clamp.data["use"], self._named(clamp)
                clamps.append(Clamp(use, label, component, at, where, own, named=named))
            elif component is not None and at is not None:
                message = f"a component of kind {component.kind} cannot be clamped on a line"
                clamp.refuse(("use",), message)
        return tuple(clamps)

    def _equipment(
        self, item: SourceMapping, component: Component, *, clamped: bool
    ) -> item_keys.Equipment:
        equipment, label = item_keys.read_equipment(item), item.data.get("label")
        if equipment.planned_depth is not None or not isinstance(label, str):
            return equipment
        serial = equipment.serial if isinstance(equipment.serial, str) else None
        # a depth in the label is the default of `planned_depth`
        named = named_depth(label, component, serial, clamped=clamped)
        return equipment if named is None else equipment.planned_for(named)

    def _assembly(self, entry: CatalogueEntry, item: SourceMapping) -> tuple[Piece, ...]:
        if entry.id in self._open:
            item.refuse(("use",), f"assembly `{entry.id}` contains itself")
            return ()
        if entry.id not in self._assemblies:
            self._open.append(entry.id)
            self._assemblies[entry.id] = self.read(entry.section.into(self._problems), "parts")
            self._open.pop()
        place = item.problem((), "")  # all pieces get the position of the item
        prefix, named = f"{self._label(item)} " if "label" in item.data else "", self._named(item)
        line, column = place.line, place.column
        return tuple(
            replace(piece, label=prefix + piece.label, line=line, column=column, named=named)
            for piece in self._assemblies[entry.id]
        )

    def _with_serials(
        self, pieces: tuple[Piece, ...], item: SourceMapping, count: int
    ) -> tuple[Piece, ...]:
        """Distribute the serial numbers of an item over the parts of its assembly.

        The numbers belong to the instruments and releases of the assembly. They belong to the
        floats if the assembly has neither. An item with a `count` lists the numbers of one assembly
        after the other.
        """
        numbers = item_keys.read_equipment(item).serials
        if not numbers:
            return pieces
        parts = parts_of(pieces)
        found = ([one for one in parts if one.component.role in roles] for roles in _NUMBERED)
        own = next(filter(None, found), [])
        firsts = [0, *accumulate(one.component.items or 1 for one in own)]
        total = firsts.pop()
        if len(numbers) != total * count:
            named = " and ".join(dict.fromkeys(one.use for one in own))
            wanted = f"{total * count} number{'s' * (total * count != 1)}"
            message = f"`serial` must have {wanted} for {named}, not {len(numbers)}"
            if not own:
                message = "`serial`: this item contains no instrument, release or float"
            item.refuse(("serial",), message)
            return pieces
        mine = {
            id(one): tuple(
                numbers[repeat * total + first + at]
                for repeat in range(count)
                for at in range(one.component.items or 1)
            )
            for first, one in zip(firsts, own, strict=True)
        }

        def numbered(part: _Part) -> _Part:
            if id(part) not in mine:
                return part
            equipment = part.equipment.model_copy(update={"serial": mine[id(part)]})
            return replace(part, equipment=equipment)

        return tuple(
            replace(numbered(piece), clamps=tuple(map(numbered, piece.clamps))) for piece in pieces
        )

    def _filled(
        self,
        pieces: tuple[Piece, ...],
        assembly: Assembly,
        entry: CatalogueEntry,
        item: SourceMapping,
    ) -> tuple[Piece, ...]:
        """Use the values of an assembly for those parts that have no values of their own."""
        for key in ASSEMBLY_FIGURES:
            value = getattr(assembly, key)
            if value is None:
                continue
            given: dict[str, Any] = item.data if key in item.data else entry.section.data
            source = (given.get("sources") or {}).get(key) or given.get("source")
            filled = tuple(_with_figure(piece, key, value, source) for piece in pieces)
            if filled == pieces and key in item.data:
                message = f"all parts of `{entry.id}` already have a `{key}`"
                item.refuse(
                    (key,), f"{message}; to change one, list the parts separately", key=True
                )
            pieces = filled
        return pieces

    def _entry(self, item: SourceMapping) -> CatalogueEntry | None:
        use = item.data.get("use")
        if not isinstance(use, str):
            message = "`use` must be the id of a component" if "use" in item.data else None
            lacks = "" if message else "no component chosen"
            item.refuse(("use",), message or "`use` is missing", lacks=lacks)
            return None
        entry = self._catalogue.entry(use)
        if entry is None:
            offer = " (`calm catalog list` shows all)"
            if near := self._suggested(use):
                *others, last = near
                offer = f"; did you mean {', '.join(others)}{' or ' * bool(others)}{last}?"
            if some := self._catalogue.of_a_sort(use):
                offer = f"; {use.rstrip('s')}s are {', '.join(some)} … (`calm catalog list {use}`)"
            item.refuse(("use",), f"`use: {shown(use)}`: no such component{offer}")
            return None
        hidden = self._catalogue.hidden(use)
        if hidden:
            notice = f"{use}: the definition in {entry.place} overrides that in {hidden.place}"
            if entry.section.base is not None:
                keys = ", ".join(f"`{key}`" for key in entry.replaces)
                notice = (
                    f"{use}: {entry.place} overrides {keys} of the definition in {hidden.place}"
                )
            if entry.section.base is None or entry.replaces:
                self._notices += [notice] * (notice not in self._notices)
        return entry

    def _suggested(self, use: str) -> list[str]:
        from calm.files.catalogue_search import WordIndex

        if len(use) > LONGEST_TEXT:
            return []
        if self._index is None:
            self._index = WordIndex(self._catalogue)
        return self._index.suggested(use, self._catalogue.nearest(use))

    def _definition(
        self, entry: CatalogueEntry, item: SourceMapping, item_keys: frozenset[str]
    ) -> Component | Assembly | None:
        if entry.id not in self._defined:
            own = entry.section.into(self._problems)
            self._defined[entry.id] = self._define(entry, own)
        definition = self._defined[entry.id]
        if isinstance(definition, Assembly):
            allowed = _ASSEMBLY_KEYS.union(ASSEMBLY_FIGURES, _SOURCE_KEYS)
            for key in item.data.keys() - allowed:
                message = unknown(f"`{key}` cannot be set on an assembly", key, allowed)
                item.refuse((key,), message, key=True)
            figures = {key: item.data[key] for key in item.data.keys() - _ASSEMBLY_KEYS & allowed}
            section = item.holding(figures).over(entry.section)
            filling = self._define(entry, section) if figures else definition
            return filling if isinstance(filling, Assembly) else None
        if definition is None:
            return None
        own_keys = item_keys if definition.kind in FLEXIBLE_KINDS else item_keys - {"length"}
        overriding = {key: value for key, value in item.data.items() if key not in own_keys}
        if not overriding and not isinstance(definition, Outline):
            return definition
        if "kind" in overriding:
            message = "`kind` cannot be overridden; define a component of your own"
            item.refuse(("kind",), message, key=True)
            return None
        void = components.contradicted(
            definition.kind, entry.section.data.keys(), overriding.keys()
        )
        section = item.holding(overriding).over(entry.section, dropping=void)
        hinted = item_keys if definition.kind == "cable" else item_keys - {"termination"}
        component = self._define(entry, section, also_allowed=hinted)
        if isinstance(component, Outline):
            item.refuse(("use",), component.asks(entry.id))
        if not isinstance(component, Component):
            return None
        self._keep_looser_limits(entry, item, definition, component)
        if not self._in_air and isinstance(definition, Component):
            place = f"line {item.problem((), '').line}: "
            doubts = components.odd_overrides(entry.id, definition, component, overriding.keys())
            self._notices += (place + doubt for doubt in doubts)
        return component

    def _keep_looser_limits(
        self,
        entry: CatalogueEntry,
        item: SourceMapping,
        definition: Component | Outline,
        component: Component,
    ) -> None:
        """Record overrides by an item that make the design check less strict.

        Such an override increases a permitted load, depth or tilt, or the buoyancy. It may also
        decrease the weight, the diameter or the drag.
        """
        loads = () if isinstance(component, Anchor) else LENIENT_IF_LESS
        sourced = item.data.get("sources")
        for key in (*LENIENT_IF_GREATER, *loads):
            before, after = (getattr(each, key, None) for each in (definition, component))
            if before is None or after is None:
                continue
            quantity = quantity_of(type(component).model_fields[key])
            if quantity and (after < before if key in loads else after > before):
                name, source = f"{key} of {self._label(item)}", f"the definition of {entry.id}"
                backed = "source" in item.data or (isinstance(sourced, dict) and key in sourced)
                limit = LimitKey(name, quantity.dimension, after, before, source, backed)
                self.looser.append(limit)

    def _define(
        self, entry: CatalogueEntry, section: SourceMapping, *, also_allowed: Iterable[str] = ()
    ) -> Defined | None:
        context = IN_AIR if self._in_air else None
        return define(entry, section, also_allowed=also_allowed, context=context)

    def _count(self, item: SourceMapping) -> int:
        text = item.data.get("count", "1")
        try:
            count = _COUNT.read(text)
            if count != int(count):
                raise QuantityError("must be a whole number")
        except QuantityError as error:
            item.refuse(("count",), about_quantity("count", text, error))
            return 1
        return int(count)

    def _quantity(
        self, item: SourceMapping, key: str, kind: QuantityField, need: str
    ) -> float | None:
        if item.data.get(key) is None:
            there = key in item.data
            message = f"`{key}` has no value" if there else f"`{key}` is missing: {need}"
            place = (key,) if there else ()
            label = item.data.get("label") or item.data.get("use") or "a piece"
            item.refuse(place, message, lacks=f"no {_WORDS.get(key, key)} on {shown(label)}")
            return None
        try:
            return kind.read(item.data[key])
        except QuantityError as error:
            item.refuse((key,), about_quantity(key, item.data[key], error))
            return None

    def _named(self, item: SourceMapping) -> str:
        return self._label(item) if "label" in item.data else ""

    def _label(self, item: SourceMapping) -> str:
        label = item.data.get("label", item.data["use"])
        if not isinstance(label, str):
            item.refuse(("label",), "`label` must be plain text")
        return str(label)


def _with_figure(piece: Piece, key: str, value: float, source: str | None) -> Piece:
    def filled(part: _Part) -> _Part:
        component: Component = part.component
        if not _lacks(component, key, clamped=isinstance(part, Clamp)):
            return part
        known: dict[str, Any] = {key: value}
        if source:
            known["sources"] = {**(component.sources or {}), key: source}
        return replace(part, component=component.model_copy(update=known))

    return filled(piece.with_clamps(filled))


def _lacks(component: Component, key: str, *, clamped: bool) -> bool:
    if key in ("working_load", "breaking_load"):
        return not clamped and component.working_load is component.breaking_load is None
    if key == "grip":
        return clamped and component.grip is component.breaking_load is None
    roles = {
        "opening_load": ("release",),
        "max_tilt": ("release", "instrument"),
        "depth_rating": ("release", "instrument", "float"),
    }
    return component.role in roles[key] and getattr(component, key) is None
