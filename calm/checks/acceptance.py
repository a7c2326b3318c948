"""Findings that the design accepts, with a reason, until a day."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import date

from calm.checks.finding import Finding, State
from calm.files import Accept


@dataclass(frozen=True)
class Acceptance:
    """The accepts of a mooring file on a day; only failures and what is unknown are accepted."""

    accepts: tuple[Accept, ...]
    day: date

    def of(self, finding: Finding) -> Finding:
        """The finding, accepted where the file does."""
        if finding.state not in (State.FAIL, State.UNKNOWN):
            return finding
        for accept in self.accepts:
            if accept.counts_on(self.day) and accept.covers(finding.rule, finding.component):
                return replace(finding, state=State.ACCEPTED, accept=accept)
        return finding

    def notices(self, accepted: Iterable[Finding]) -> Iterator[str]:
        """Notices of accepts that do not count, or that no finding needs.

        Parameters
        ----------
        accepted : every finding that is accepted
        """
        used = {finding.accept for finding in accepted}
        for accept in sorted(self.accepts, key=lambda one: one.line):
            of = f" of {accept.component}" if accept.component is not None else ""
            what = f"line {accept.line}: `accept` for {accept.rule}{of}"
            if accept.date is not None and accept.date > self.day.isoformat():
                yield f"{what} is dated {accept.date}, in the future: it does not count yet"
            elif not accept.counts_on(self.day):
                yield f"{what} ended on {accept.until}: it no longer counts"
            elif accept not in used:
                yield f"{what} is not needed: nothing there fails or is unknown"
