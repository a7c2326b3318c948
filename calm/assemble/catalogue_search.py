"""Search of the catalogue by words and by limits on values."""

from calm.assemble.component_forces import datasheet
from calm.errors import CalmError
from calm.files import Catalogue
from calm.files.catalogue_search import Figures, WordIndex


class Index(WordIndex):
    """Search index of a catalogue, including the values of the components."""

    def __init__(self, catalogue: Catalogue) -> None:
        super().__init__(catalogue)
        self._figures: dict[str, Figures] = {}

    def figures(self, id: str) -> Figures:
        """Return the values of a component, keyed by column."""
        if id not in self._figures:
            self._figures[id] = figures_of(self.catalogue, id)
        return self._figures[id]


def figures_of(catalogue: Catalogue, id: str) -> Figures:
    """Return the values of a component or assembly in SI units, keyed by the names in `COLUMNS`."""
    try:
        definition = catalogue.get(id)
        sheet = datasheet(definition, catalogue)
    except CalmError:
        return {}
    return {
        "net": None if sheet is None else sheet.net_buoyancy,
        "breaking": getattr(definition, "breaking_load", None),
        "working": getattr(definition, "working_load", None),
        "depth": getattr(definition, "depth_rating", None),
        "drag": None if sheet is None else sheet.kn,
        "mass": getattr(definition, "mass", None),
    }
