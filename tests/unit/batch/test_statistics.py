"""What a batch result says, by hand and by numpy."""

import errno
import tracemalloc

import numpy as np
import pytest

from calm.batch.finished import open_result
from calm.batch.statistics import series
from calm.batch.statistics.extremes import Fit, LevelsRefused
from calm.batch.statistics.summary import (
    MOST_INTERVALS,
    SHARES,
    WORST,
    distribution_of,
    envelope_of,
    summarize,
)
from calm.errors import UsageError
from calm.report.batch_summary import summary_document
from tests.unit.batch.made_result import FILE, made_mooring, make_result, stormy

HOUR = np.timedelta64(1, "h")


@pytest.fixture(scope="module")
def mooring(tmp_path_factory):
    return made_mooring(tmp_path_factory.mktemp("made"))


def hours(count):
    return np.datetime64("2001-01-01", "ns") + np.arange(count) * HOUR


def test_percentiles_are_linear_between_order_statistics():
    values = np.random.default_rng(1).standard_normal(1237).astype(np.float32)
    one = distribution_of(values, hours(len(values)))
    by_numpy = np.percentile(values.astype(np.float64), [50.0, 90.0, 99.0, 99.9])
    assert one.percentiles == pytest.approx(by_numpy.tolist(), rel=1e-14)


def test_a_distribution_by_hand():
    values = np.array([3.0, 1.0, np.nan, 11.0, 5.0, 11.0, 7.0, 9.0], np.float32)
    one = distribution_of(values, hours(8))
    assert one.count == 7
    assert one.mean == pytest.approx(47.0 / 7.0, rel=1e-15)
    # order statistics 1 3 5 7 9 11 11: ranks 1 + 6 p
    assert one.percentiles == pytest.approx((7.0, 11.0, 11.0, 11.0))
    assert one.maximum == 11.0
    assert one.time == hours(8)[3]


def test_an_exceedance_curve_ends_at_a_single_profile():
    values = np.arange(1.0, 1001.0)
    one = distribution_of(values, hours(1000))
    assert one.share[0] == 1.0
    assert one.value[0] == 1.0
    assert one.share[-1] == 1e-3
    assert one.value[-1] == 1000.0
    assert (np.diff(one.value) > 0.0).all()
    assert (one.share[:-1] == SHARES[SHARES > 1e-3][: len(one.share) - 1]).all()
    # a share s of the profiles reaches the value at s, to within one profile
    reached = [(values >= value).mean() for value in one.value]
    assert np.abs(reached - one.share).max() <= 1e-3


def test_nothing_known_is_no_distribution():
    assert distribution_of(np.full(3, np.nan), hours(3)) is None


def test_an_envelope_holds_every_value():
    count = 3 * MOST_INTERVALS + 17
    values = np.random.default_rng(2).standard_normal(count)
    values[5:7] = np.nan
    begin, low, high = envelope_of(values, hours(count))
    assert len(begin) == len(low) == len(high) == MOST_INTERVALS
    assert high.max() == np.nanmax(values)
    assert low.min() == np.nanmin(values)
    ends = np.searchsorted(hours(count), begin)
    for start, stop, least, most in zip(ends, ends[1:], low, high, strict=False):
        assert (least, most) == (np.nanmin(values[start:stop]), np.nanmax(values[start:stop]))


def test_each_profile_of_a_short_record_is_drawn():
    values = np.array([1.0, np.nan, 3.0])
    begin, low, high = envelope_of(values, hours(3))
    assert (begin == hours(3)).all()
    assert np.array_equal(low, values, equal_nan=True)
    assert np.array_equal(high, values, equal_nan=True)


def test_profiles_are_counted_by_how_they_ended(mooring):
    summary = summarize(make_result(10, status=[0, 1, 0, 3, 3, 2, 0, 1, 0, 0]), mooring)
    assert summary.statuses == {
        "converged": 5, "no-equilibrium": 2, "slack": 1, "no-current": 2
    }  # fmt: skip
    assert (summary.count, summary.solved, summary.unsolved) == (10, 5, 3)
    assert {ending.value: count for ending, count in summary.endings.items()} == {
        "solved": 5, "without equilibrium": 3, "not converged": 0, "without data": 2
    }  # fmt: skip
    assert summary.years == pytest.approx(5.0 / 8766.0)
    assert all(part.tilt.count == 5 for part in summary.parts)


def test_every_component_and_clamp_has_its_own_figures(mooring):
    ramp = np.arange(101.0)[:, None]
    summary = summarize(
        make_result(
            101,
            knockdown=ramp * [5.0, 4.0, 3.0, 2.0, 0.0],
            tilt=ramp * [0.1, 0.2, 0.3, 0.2, 0.0],
            tension_top=1000.0 + ramp * [0.0, 1.0, 2.0, 3.0, 4.0],
            tension_bottom=1050.0 + 0.0 * ramp * np.ones(5),
            clamp_knockdown=ramp * [4.5, 3.5],
            clamp_tension=ramp * [8.0, 9.0],
        ),
        mooring,
    )
    by_label = {part.label: part for part in summary.parts}
    assert list(by_label) == [
        "sphere", "wire", "meter", "rope", "anchor", "sbe37 1", "sbe37 2"
    ]  # fmt: skip
    assert [part.label for part in summary.parts if part.clamped] == ["sbe37 1", "sbe37 2"]
    assert by_label["meter"].knockdown.percentiles == pytest.approx((150.0, 270.0, 297.0, 299.7))
    assert by_label["meter"].knockdown.maximum == 300.0
    assert by_label["meter"].knockdown.time == np.datetime64("2001-01-05T04:00")
    assert by_label["wire"].tilt.mean == pytest.approx(10.0)
    # the greater of both ends: 1050 until the upper one passes it, half way
    assert by_label["wire"].tension.percentiles[0] == pytest.approx(1050.0)
    assert by_label["wire"].tension.maximum == 1100.0
    assert by_label["sbe37 2"].tension.maximum == 900.0
    assert by_label["sbe37 1"].knockdown.maximum == 450.0


def test_levels_are_refused_where_profiles_were_not_solved(mooring):
    count = 12 * 366
    summary = summarize(stormy(mooring, count, "24h", status=np.arange(count) == 700), mooring)
    for response in summary.responses:
        for refusal in response.return_levels:
            assert "1 without equilibrium" in refusal.reason
    gaps = summarize(stormy(mooring, count, "24h", status=3 * (np.arange(count) == 700)), mooring)
    assert isinstance(gaps.responses[0].return_levels[1], Fit)


def test_the_worst_profiles_come_with_their_dates(mooring):
    knockdown = np.arange(100.0)
    knockdown[[3, 70]] = 500.0  # of like ones the first comes first
    tilt = np.zeros((100, 5))
    tilt[7] = 5.0, 9.0, 2.0, 3.0, 0.0
    tension = np.ones((100, 5))
    tension[40, -1] = 99.0
    summary = summarize(
        make_result(
            100, knockdown=knockdown, tilt=tilt, tension_top=tension,
            clamp_tilt=np.eye(100)[:, [9, 10]] * 20.0, x_top=3.0 + 0.0 * knockdown,
            y_top=4.0 + 0.0 * knockdown,
        ),
        mooring,
    )  # fmt: skip
    worst = summary.worst["knockdown"]
    assert len(worst) == WORST
    assert [profile.knockdown for profile in worst[:4]] == [500.0, 500.0, 99.0, 98.0]
    assert [str(profile.time)[:13] for profile in worst[:2]] == ["2001-01-01T03", "2001-01-03T22"]
    assert worst[0].offset == 5.0
    by_tilt = summary.worst["tilt"]
    assert [(one.tilt, one.leaning) for one in by_tilt[:3]] == [
        (20.0, "sbe37 1"), (20.0, "sbe37 2"), (9.0, "wire")
    ]  # fmt: skip
    assert summary.worst["anchor_tension"][0].anchor_tension == 99.0
    assert summary.worst["anchor_tension"][0].time == hours(41)[40]


def test_a_short_record_says_why_it_has_no_return_levels(mooring):
    summary = summarize(stormy(mooring, 500), mooring)
    for response in summary.responses:
        gev, pot = response.return_levels
        assert isinstance(gev, LevelsRefused) and "whole years" in gev.reason
        assert isinstance(pot, LevelsRefused) and "21 days" in pot.reason


def test_a_line_without_a_shape_in_still_water_has_no_knockdown(mooring):
    made = make_result(5, knockdown=np.full((5, 5), np.nan), tilt=np.ones((5, 5)))
    summary = summarize(made, mooring)
    assert summary.parts[0].knockdown is None
    assert summary.parts[0].tilt.count == 5
    rule = next(rule for rule in summary.rules if rule.name == "knockdown")
    assert (rule.judged, rule.fails, rule.unknown) == (0, None, 1)
    assert summary.worst["knockdown"] == ()
    assert len(summary.worst["tilt"]) == 5
    assert np.isnan(summary.worst["tilt"][0].knockdown)


def test_one_profile_will_do(mooring):
    summary = summarize(make_result(1), mooring)
    assert summary.parts[0].tilt.percentiles == (1.0,) * 4
    assert summary.years == 0.0


def test_a_part_called_top_keeps_its_own_figures(tmp_path):
    mooring = made_mooring(tmp_path, FILE.replace("label: anchor", "label: top"))
    labels = ("sphere", "wire", "meter", "rope", "top")
    tilt = np.arange(5.0) * np.ones((3, 1))
    summary = summarize(make_result(3, labels=labels, tilt=tilt), mooring)
    assert [part.tilt.maximum for part in summary.parts[:5]] == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_what_is_no_result_is_refused(mooring):
    for other in (make_result(3).drop_vars("status"), make_result(3).drop_attrs(deep=True)):
        with pytest.raises(UsageError, match="not a result of calm batch"):
            summarize(other, mooring)


@pytest.mark.thorough
def test_memory_grows_by_a_few_columns_whatever_the_parts(mooring, tmp_path, monkeypatch):
    # of 46 columns; what does not grow is taken away by the difference of two lengths
    monkeypatch.setattr(series, "_ROWS", 1024)
    peaks = []
    for count in (40_000, 120_000):
        path = tmp_path / f"{count}.nc"
        made = make_result(count, knockdown=np.arange(count) % 1009)
        sizes = {name: {"chunksizes": (4096, *made[name].shape[1:])} for name in made.data_vars}
        made.to_netcdf(path, engine="h5netcdf", encoding=sizes)
        del made
        tracemalloc.start()
        with open_result(path) as opened:
            tracemalloc.reset_peak()  # opening is xarray's
            summarize(opened, mooring, tmp_path)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    # of each profile its time (8), four or five columns (4 each), and a few marks (1 each)
    assert (peaks[1] - peaks[0]) / 80_000 < 32.0


def test_a_file_says_what_memory_says(mooring, tmp_path, monkeypatch):
    monkeypatch.setattr(series, "_ROWS", 64)
    made, path = stormy(mooring, 1000, status=np.arange(1000) % 7 == 3), tmp_path / "made.nc"
    chunks = {name: {"chunksizes": (100, *made[name].shape[1:])} for name in made.data_vars}
    made.to_netcdf(path, engine="h5netcdf", encoding=chunks)
    with open_result(path) as opened:
        from_file = summarize(opened, mooring, tmp_path)
    assert [one.name for one in tmp_path.iterdir()] == [path.name]
    from_memory = summarize(made, mooring)
    assert summary_document(from_file) == summary_document(from_memory)
    assert from_file.source == from_memory.source == {"notes": "none", "input_sha256": "0" * 64}


def test_no_room_for_the_temporary_file_is_said(mooring, tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(series, "TemporaryFile", full)
    with pytest.raises(UsageError, match=r"cannot gather the statistics in .*No space left"):
        summarize(make_result(5), mooring, tmp_path)
