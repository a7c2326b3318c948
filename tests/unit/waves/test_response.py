"""Lines in waves against closed forms, and a float against a panel method."""

from dataclasses import replace
from math import cos, pi, sin, sqrt

import numpy as np
import pytest
from scipy.special import j1, jv

from calm.case import load
from calm.errors import InputError
from calm.files import Cable
from calm.records import sea_states
from calm.shipped import shipped_folder
from calm.waves.analysis import analyse
from calm.waves.buoy import END_LOSS, Buoy, bessel, buoy_of
from calm.waves.fatigue import greatest_of, passing_probability
from calm.waves.lumped_line import SHORTEST, LumpedLine, _axial, lumped_line
from calm.waves.response import (
    Waves,
    _Afloat,
    _linearised,
    _slope,
    _solved,
    _undamped,
    respond,
    wave_numbers,
)

DENSITY, GRAVITY = 1027.0, 9.81


def plumb(length, mass, axial, tension, count, drag=0.0):
    """A plumb line, `count` springs of a uniform line; its lower end is fixed."""
    n, step = count + 1, length / count
    lumps = np.full(n, mass * step)
    lumps[[0, -1]] *= 0.5
    none, down = np.zeros(n), np.tile([0.0, 0.0, -1.0], (n, 1))
    return LumpedLine(
        position=np.column_stack([none, none, -np.linspace(0.0, length, n)]),
        mass=lumps, added_across=none, added_along=none, water_across=none, water_along=none,
        across_drag=drag * lumps / mass, along_drag=0.02 * drag * lumps / mass, any_drag=none,
        tangent=down, tension=np.full(count, tension), stiffness=np.full(count, axial / step),
        spring=down[1:], span=np.full(count, step), current=np.zeros((n, 3)),
        piece_spring=np.array([0]), piece_below=np.array([1]), piece_node=np.array([0]),
        top_pieces=1, inextensible=(),
    )  # fmt: skip


def waves(omega, depth=5000.0):
    return Waves(np.asarray(omega, float), 90.0, depth, DENSITY, GRAVITY)


FOLLOWER = Buoy(1000.0, 1500.0, 1.0, 0.5, 0.0, 0.0, follows=True)


@pytest.mark.parametrize(("axial", "mass"), [(4.0e6, 0.35), (6.577e6, 0.4522), (8.4e4, 0.29)])
def test_an_axial_wave_in_a_line_of_4600_m(axial, mass):
    """EA k cot(kL) below a float that follows the waves, k = ω √(m/EA); steel wire and nylon."""
    omega = np.linspace(0.3, 1.2, 10)
    line = plumb(4600.0, mass, axial, 5000.0, 2000)
    sea = sea_states.spectrum_of("bretschneider", 3.0, 9.0, 3.3)
    response, _ = respond(line, FOLLOWER, waves(omega), sea)
    k = omega * sqrt(mass / axial)
    expected = np.abs(axial * k / np.tan(k * 4600.0))
    # the lumped line disperses by (k h)²/24, at most 1e-4 here, more beside its resonances
    assert np.abs(response.pull[:, 0]) == pytest.approx(expected, rel=0.02)


def test_elements_converge_at_second_order():
    omega, axial, mass = np.array([1.0]), 4.0e6, 0.35
    sea = sea_states.spectrum_of("bretschneider", 3.0, 9.0, 3.3)
    k = 1.0 * sqrt(mass / axial)
    errors = []
    for count in (100, 200, 400):
        response, _ = respond(
            plumb(4600.0, mass, axial, 5000.0, count), FOLLOWER, waves(omega), sea
        )
        top = abs(plumb(4600.0, mass, axial, 5000.0, count).upper_ends(response.pull)[0, 0])
        errors.append(top / abs(axial * k * cos(k * 4600.0) / sin(k * 4600.0)) - 1.0)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


def test_a_taut_string_pushed_at_its_free_end():
    """F tan(kL) / (T k), k = ω √(m/T)."""
    line = plumb(100.0, 2.0, 1e8, 3000.0, 400)
    omega = np.array([0.2, 0.5, 0.8])
    nothing = np.zeros((3, 401, 3), complex)
    push = nothing.copy()
    push[:, 0, 0] = 1.0
    motion = _solved(_undamped(line), None, omega, nothing, push, np.zeros((401, 3, 3)))
    k = omega * sqrt(2.0 / 3000.0)
    assert motion[:, 0, 0].real == pytest.approx(np.tan(k * 100.0) / (3000.0 * k), rel=1e-4)
    assert np.abs(motion[:, :, 1:]).max() < 1e-12


def test_an_undamped_string_swings_at_its_natural_frequencies():
    """(2n - 1) π/2 √(T/m) / L of one fixed at one end: there its response is greatest."""
    line = plumb(100.0, 2.0, 1e8, 3000.0, 200)
    speed = sqrt(3000.0 / 2.0)
    for number in (1, 2, 3):
        natural = (2 * number - 1) * pi / 2.0 * speed / 100.0
        omega = natural * np.linspace(0.99, 1.01, 81)
        push = np.zeros((81, 201, 3), complex)
        push[:, 0, 0] = 1.0
        zero = np.zeros((81, 201, 3), complex)
        motion = _solved(_undamped(line), None, omega, zero, push, np.zeros((201, 3, 3)))
        found = omega[np.abs(motion[:, 0, 0]).argmax()]
        assert found == pytest.approx(natural, rel=4e-4)


def test_the_swing_of_a_shipped_mooring_by_hand():
    """A rigid pendulum upside down, 2π √(Σ(m + a)h² / Σ B h): ADCP, release and chain on a weight.

    The float, a sphere of 1.42 m and 4511 N, moves half of the water that it displaces; without a
    mass in its figures it has that water's less its lift. Within 2 %: half of it is lumped at
    either end, and the chain is not quite straight.
    """
    mooring = load(f"{shipped_folder('lines')}/tidal-adcp.yaml")
    line = lumped_line(mooring.leg, mooring.leg.equilibrium(), 1.0)
    water = 1025.0 * pi * 1.42**3 / 6.0
    # half of the float is at its upper end, and half of its water goes with it in every direction
    assert [line.added_along[0], line.added_across[0]] == pytest.approx([0.25 * water] * 2)
    foot, inertia, righting = 0.0, 0.0, 0.0
    for piece in reversed(mooring.file.pieces[:-1]):
        component, length = piece.component, piece.length
        metres = length if component.kind == "chain" else 1.0
        mass = 1.5 * water - 4511.0 / 9.80665 if piece.index == 0 else component.mass * metres
        inertia += mass * (foot + length / 2.0) ** 2
        righting += component.net_buoyancy * metres * (foot + length / 2.0)
        foot += length
    expected = sqrt(righting / inertia)
    omega, n = np.linspace(0.8, 1.2, 401) * expected, len(line.mass)
    nothing = np.zeros((len(omega), n, 3), complex)
    push = nothing.copy()
    push[:, 0, 0] = 1.0
    motion = _solved(_undamped(line), None, omega, nothing, push, np.zeros((n, 3, 3)))
    assert omega[np.abs(motion[:, 0, 0]).argmax()] == pytest.approx(expected, rel=0.02)


def test_a_short_element_adds_no_more_than_its_length():
    """The chain above the release has elements of 2 cm: they added the mass of a metre each."""
    mooring = load(f"{shipped_folder('lines')}/tidal-adcp.yaml")
    solution = mooring.leg.equilibrium()
    span = np.linalg.norm(np.diff(solution.position, axis=0), axis=1)
    assert (span[solution.element_clamp < 0] < SHORTEST).any()
    line = lumped_line(mooring.leg, solution, 1.0)
    mass = 1025.0 * pi * 1.42**3 / 6.0 - 4511.0 / 9.80665  # of the float, from its lift
    drag = 0.0
    for piece in mooring.file.pieces[:-1]:
        metres = piece.length if piece.component.kind == "chain" else 1.0
        mass += piece.component.mass * metres if piece.index else 0.0
        drag += float(solution.carried.normal_drag[piece.index]) * metres
    assert line.mass.sum() == pytest.approx(mass, rel=1e-3)
    assert (line.across_drag + line.any_drag).sum() == pytest.approx(drag, rel=1e-2)


def test_a_sea_that_is_all_but_flat_leaves_the_static_line():
    mooring = load(f"{shipped_folder('lines')}/tidal-adcp.yaml")
    flat = sea_states.spectrum_of("bretschneider", 1e-6, 8.0, 3.3)
    (state,) = analyse(mooring.leg, [flat], 90.0).states
    result = mooring.solve()
    for piece, row in zip(result.components, state.components, strict=False):
        assert row.tension_std < 1e-3
        if row.index:
            assert row.tension_mean == pytest.approx(piece.tension_top, rel=1e-9)
            assert row.tension_max == pytest.approx(row.tension_mean, rel=1e-5)


def test_the_spectrum_of_the_tension_holds_its_variance_and_a_piece_what_its_elements_reach():
    mooring = load(f"{shipped_folder('lines')}/tidal-adcp.yaml")
    (state,) = analyse(
        mooring.leg, [sea_states.spectrum_of("bretschneider", 2.0, 9.0, 3.3)], 90.0
    ).states
    omega, density = state.spectrum
    _, mean, deviation, reached = state.along
    # the moments are sums over bands of frequency: within 2 % of the trapezes
    assert np.trapezoid(density, omega) == pytest.approx(float(deviation[0]) ** 2, rel=0.02)
    rows = [row for row in state.components if row.index]
    assert max(row.greatest for row in rows) >= float(reached[1:].max()) - 1e-6
    assert min(row.least for row in rows) <= float((2.0 * mean - reached)[1:].min()) + 1e-6


def test_a_rope_that_stretches_by_a_curve_is_as_stiff_as_its_slope():
    """A tenth of its length at 100 kN, straight: EA is 1 MN at any tension."""
    curve = [[0.1, 0.01], [0.5, 0.05], [1.0, 0.1]]
    rope = Cable.model_validate(
        {"kind": "cable", "diameter": "20 mm", "weight": "1 N/m", "breaking_load": "100 kN"}
        | {"elongation": curve}
    )
    assert [_axial(rope, pull) for pull in (0.0, 5e3, 3e4)] == pytest.approx([1e6] * 3, rel=0.02)


def test_without_drag_the_response_is_linear_in_the_height():
    line = plumb(1000.0, 0.4, 4e6, 5000.0, 100)
    found = []
    for height in (0.5, 5.0):
        sea = sea_states.spectrum_of("bretschneider", height, 9.0, 3.3)
        response, _ = respond(line, FOLLOWER, waves(sea.frequencies(64)), sea)
        found.append(response.moments(response.pull)[0])
    assert found[1] == pytest.approx(10.0 * found[0], rel=1e-12)


def test_drag_takes_energy_out_and_nothing_moves_without_waves():
    sea, tiny = (sea_states.spectrum_of("bretschneider", h, 9.0, 3.3) for h in (5.0, 1e-9))
    free, dragged = plumb(3000.0, 0.3, 9e4, 3000.0, 200), plumb(3000.0, 0.3, 9e4, 3000.0, 200, 20.0)
    found = []
    for line, state in ((free, sea), (dragged, sea), (dragged, tiny)):
        response, _ = respond(line, FOLLOWER, waves(state.frequencies(96)), state)
        found.append(response.moments(response.pull)[0][0])
    assert found[1] < found[0]
    assert found[2] == pytest.approx(found[0] * 1e-9 / 5.0, rel=1e-3)


@pytest.mark.parametrize(("mean", "deviation"), [(0.0, 1.0), (0.3, 0.2), (2.0, 0.1), (-0.5, 0.4)])
def test_linearised_drag_against_quadrature(mean, deviation):
    """E[F v'] / E[v'²] of F = |v|v over a Gaussian flow, by the trapezoidal rule."""
    x = np.linspace(-10.0, 10.0, 200_001)
    flow = mean + deviation * x
    bell = np.exp(-0.5 * x**2)
    found = np.trapezoid(np.abs(flow) * flow * x * bell, x)
    expected = found / (deviation * np.trapezoid(x**2 * bell, x))
    assert _slope(abs(mean), deviation) == pytest.approx(expected, rel=1e-6)


def test_linearised_drag_of_cylinders_and_spheres_against_quadrature():
    """E[F v'] / E[v'²] of F = K |v| v in the plane across a cylinder, and in space for a sphere.

    The seven points of each direction are within 3 % of a fine grid.
    """
    mean, deviation = np.array([0.0, 0.4, 0.0]), np.array([0.15, 0.3, 0.5])
    one = plumb(10.0, 1.0, 1e6, 1e3, 1)
    none = np.zeros(2)
    still = replace(
        one, across_drag=none, along_drag=none, current=np.tile([0.4, 0.0, 0.0], (2, 1))
    )
    grid = np.stack(np.meshgrid(*[np.linspace(-5.0, 5.0, 61)] * 3, indexing="ij"), -1)
    weight = np.exp(-0.5 * (grid**2).sum(-1, keepdims=True))
    flow = mean + deviation * grid
    for line, ways in (
        (replace(still, across_drag=np.ones(2)), [0.0, 1.0, 1.0]),
        (replace(still, any_drag=np.ones(2)), [1.0, 1.0, 1.0]),
    ):
        size = np.linalg.norm(flow * ways, axis=-1, keepdims=True)
        work = (size * flow * deviation * grid * weight).sum((0, 1, 2))
        expected = ways * work / (deviation**2 * weight.sum())
        found = np.diag(_linearised(line, None, np.tile(deviation, (2, 1)))[0])[[2, 0, 1]]
        assert found == pytest.approx(expected, rel=0.03)


def test_what_weighs_as_much_as_its_water_moves_with_it():
    """Nodes and a float that no spring holds, of the mass of the water that they displace."""
    loose = plumb(40.0, 3.0, 1e-9, 1e-9, 8)
    loose = replace(
        loose, water_across=loose.mass, water_along=loose.mass,
        added_across=0.7 * loose.mass, added_along=0.2 * loose.mass,
        across_drag=3.0 * loose.mass, along_drag=loose.mass, any_drag=2.0 * loose.mass,
    )  # fmt: skip
    sea = sea_states.spectrum_of("bretschneider", 2.0, 8.0, 3.3)
    sent = waves(sea.frequencies(5))
    water = sent.velocity(loose.position)
    carried = water / (1j * sent.omega[:, None, None])
    response, _ = respond(loose, None, sent, sea)
    assert response.motion[:, :-1] == pytest.approx(carried[:, :-1], rel=1e-6, abs=1e-12)
    afloat = Buoy(2000.0, 2000.0, 1.0, 1e-9, 0.0, 0.0)
    response, _ = respond(loose, afloat, sent, sea)
    assert response.motion[:, 0, 0] == pytest.approx(carried[:, 0, 0], rel=1e-6)


def test_heave_of_a_disc_against_a_panel_method():
    """Radius 1.37 m, draft 0.875 m, 2045 kg: Capytaine 2.2 on a mesh of 14 by 40 by 14 panels.

    Added mass and radiation by formulas of a disc follow it to 5 % up to 2 rad/s, where the sea
    of a buoy is. Beyond, near its resonance at 3 rad/s, only the panels know.
    """
    omega = np.array([0.5, 1.0, 1.5, 2.0])
    disc = Buoy(2045.45, 3155.9, 1.37, 0.875, 0.0, 0.0)
    resisting, lifting = disc.heave(omega, omega**2 / GRAVITY, DENSITY, GRAVITY)
    assert np.abs(lifting / resisting) == pytest.approx([0.982, 0.940, 0.871, 0.803], rel=0.05)


def test_a_disc_without_mass_follows_the_water_below_it():
    """Added mass and radiation push it as they hold it: e^(-kT) 2 J1(kR)/(kR), and no phase."""
    omega = np.array([0.3, 1.0, 2.0, 3.5])
    number, none = omega**2 / GRAVITY, Buoy(0.0, 3000.0, 1.2, 0.6, 0.0, 0.0)
    resisting, lifting = none.heave(omega, number, DENSITY, GRAVITY)
    expected = np.exp(-0.6 * number) * 2.0 * j1(1.2 * number) / (1.2 * number)
    assert lifting / resisting == pytest.approx(expected, rel=1e-12)


def upright(radius, draft, centre, gyration, bail=0.0, pull=0.0, **more):
    """A cylinder afloat, its centre of mass above the surface and its bail below it [m], and K."""
    height = np.linspace(-draft, 0.0, 400)
    hull = np.column_stack([np.full(400, radius), height])
    displaced = DENSITY * pi * radius**2 * draft
    mass = displaced - pull / GRAVITY
    return Buoy(
        mass, displaced, radius, draft, 0.0, 0.0, profile=hull, centre=centre, bail=bail,
        gyration=gyration, **more,
    )  # fmt: skip


DISC, SPAR = (1.37, 0.875, -0.4, 1.0), (0.5, 5.0, -3.2, 2.0)


def over_slope(buoy, omega):
    """Pitch of a free float over the slope of the waves."""
    number = omega**2 / GRAVITY
    held, pushing = buoy.pitch(buoy.profile, omega, number, DENSITY, GRAVITY)
    whole = held[[[0, 1], [1, 2]]].transpose(2, 0, 1)
    return np.linalg.solve(whole, pushing.T[:, :, None])[:, 1, 0] / (1j * number)


@pytest.mark.parametrize("figures", [DISC, SPAR, (0.8, 0.4, 0.0, 0.6)])
def test_a_float_pitches_as_long_waves_slope(figures):
    assert over_slope(upright(*figures), np.array([0.02])) == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize(
    ("figures", "omega", "panels"),
    [
        (DISC, [0.5, 1.0, 1.5], [1.041, 1.184, 1.716]),
        (SPAR, [0.5, 0.8, 1.5, 2.0, 2.5], [1.353, 2.545, 1.372, 0.521, 0.265]),
    ],
)
def test_pitch_over_slope_against_a_panel_method(figures, omega, panels):
    """Capytaine 3, 40 panels round and 8 or 30 up the side: within 5 % away from the resonances.

    They are near 2 rad/s of the disc and 1 rad/s of the spar.
    """
    found = np.abs(over_slope(upright(*figures), np.array(omega)))
    assert found == pytest.approx(panels, rel=0.05)


@pytest.mark.parametrize("bail", [0.0, -5.0])
def test_the_natural_period_of_pitch(bail):
    """ω² = ρg∇ GM / (I + A), GM = R²/4T - T/2 - z and A by hand, of a spar with a loose line.

    Surge with pitch is m z + A15, less its square over m + A11 of what turns. The bail, wherever,
    adds nothing to a float that no line holds.
    """
    radius, draft, centre, gyration = SPAR
    scale, mass = END_LOSS * radius, DENSITY * pi * radius**2 * draft
    share = 1.0 - scale / draft * (1.0 - np.exp(-draft / scale))
    first = -0.5 + scale / draft - (scale / draft) ** 2
    second = 1.0 / 3.0 - scale / draft + 2.0 * (scale / draft) ** 2 - 2.0 * (scale / draft) ** 3
    added = mass * np.array([share, first * draft, second * draft**2])
    inertia = added[2] + 8.0 / 45.0 * DENSITY * radius**5 + mass * (centre**2 + gyration**2)
    inertia -= (mass * centre + added[1]) ** 2 / (mass + added[0])
    righting = mass * GRAVITY * (radius**2 / (4.0 * draft) - 0.5 * draft - centre)
    expected = sqrt(righting / inertia)
    omega = expected * np.linspace(0.97, 1.03, 121)
    sea = sea_states.spectrum_of("bretschneider", 1.0, 6.0, 3.3)
    buoy = upright(*SPAR, bail=bail)
    response, _ = respond(plumb(40.0, 1e-9, 1e-9, 1e-9, 8), buoy, waves(omega), sea, once=True)
    assert omega[np.abs(response.pitch).argmax()] == pytest.approx(expected, rel=2e-3)


def test_the_bail_moves_by_pitch_times_its_depth():
    omega, loose = np.array([0.4, 0.8, 1.6]), plumb(40.0, 1e-9, 1e-9, 1e-9, 8)
    sea = sea_states.spectrum_of("bretschneider", 1.0, 6.0, 3.3)
    top, keel = (
        respond(loose, upright(*SPAR, bail=bail), waves(omega), sea, once=True)[0]
        for bail in (0.0, -5.0)
    )
    assert keel.pitch == pytest.approx(top.pitch, rel=1e-6)
    moved = keel.motion[:, 0] - top.motion[:, 0]
    assert moved[:, 0] == pytest.approx(-5.0 * top.pitch, rel=1e-6)
    assert np.abs(moved[:, 1:]).max() < 1e-9


@pytest.mark.parametrize(("pull", "bail"), [(0.0, 0.0), (9000.0, -0.875), (9000.0, -2.0)])
def test_what_rights_a_float_by_the_energy_of_a_heeled_one(pull, bail):
    """d²U/dθ² of weight and water displaced, heeled about a bail that stays: columns of a disc."""
    radius, draft, centre, gyration = 1.37, 0.875, -0.1, 1.0
    buoy = upright(radius, draft, centre, gyration, bail, pull)
    rings, spokes = np.meshgrid((np.arange(200) + 0.5) / 200.0, 2.0 * pi * np.arange(64) / 64.0)
    x, area = radius * rings * np.cos(spokes), radius**2 * rings * 2.0 * pi / 64.0 / 200.0

    def energy(heel):
        def height(along, aside):
            return bail + cos(heel) * (along - bail) - sin(heel) * aside

        keel = height(-draft, x)
        depths = 0.5 * keel**2 / cos(heel)
        wet = float((depths * area).sum()) * DENSITY * GRAVITY
        return wet + buoy.mass * GRAVITY * height(centre, 0.0)

    step = 0.02
    expected = (energy(step) - 2.0 * energy(0.0) + energy(-step)) / step**2
    found = buoy.righting(buoy.profile, DENSITY, GRAVITY)
    assert found == pytest.approx(expected, rel=2e-3)


def test_a_pitching_hull_gives_no_energy():
    """What it radiates is no source in any motion of surge and pitch."""
    omega = np.array([0.5, 1.0, 2.0])
    for figures in (DISC, SPAR):
        buoy = upright(*figures)
        held, _ = buoy.pitch(buoy.profile, omega, omega**2 / GRAVITY, DENSITY, GRAVITY)
        lost = held.imag[[[0, 1], [1, 2]]].transpose(2, 0, 1)
        assert np.linalg.eigvalsh(lost).min() > -1e-6 * np.abs(lost).max()


def test_what_the_surge_of_a_slender_spar_radiates():
    """ω k ρ (π r² (1 - e^(-kT)))²: Haskind's relation with 2 ρ g π r² (1 - e^(-kT)) that pushes.

    The pressure of the waves, and as much again of the water that the sections move (Morison); at
    the bottom less of that, over `END_LOSS` radii: a share of 0.5 END_LOSS r / T at most.
    """
    omega, radius, draft = np.array([0.5, 1.0]), 0.02, 5.0
    number = omega**2 / GRAVITY
    buoy = upright(radius, draft, -2.0, 1.0)
    held, _ = buoy.pitch(buoy.profile, omega, number, DENSITY, GRAVITY)
    section = pi * radius**2 * (1.0 - np.exp(-number * draft))
    expected = omega * number * DENSITY * section**2
    lost = END_LOSS * radius / draft
    assert held[0].imag / omega == pytest.approx(expected, rel=1.5 * lost)


def test_the_water_at_the_bottom_of_a_hull_slopes_as_it_moves_there():
    """By differences of its vertical motion fore and aft of the axis, at the draft."""
    omega, apart = np.array([0.5, 1.5]), 0.01
    buoy, sent = upright(*SPAR), waves(omega)
    afloat = _Afloat.of(np.zeros(3), buoy, sent)
    beside = np.array([[side * apart, 0.0, -buoy.draft] for side in (-1.0, 1.0)])
    aft, fore = (sent.velocity(beside)[:, :, 2] / (1j * omega[:, None])).T
    assert afloat.slope == pytest.approx((aft - fore) / (2.0 * apart), rel=1e-4)


def test_drag_quiets_the_pitch_of_a_spar_in_high_seas():
    """Linear drag grows with the sea, and so the pitch less than that."""
    found = []
    for height in (0.5, 5.0):
        sea = sea_states.spectrum_of("bretschneider", height, 8.0, 3.3)
        spar = replace(upright(*SPAR, bail=-5.0), drag=2500.0, heave_drag=450.0)
        sent = waves(sea.frequencies(64))
        response, _ = respond(plumb(40.0, 1e-9, 1e-9, 1e-9, 8), spar, sent, sea)
        found.append(float(response.moments(response.pitch)[0]))
    assert found[0] < found[1] < 9.0 * found[0]


def test_a_given_heave_is_followed():
    given = Buoy(2000.0, 3000.0, 1.4, 0.8, 0.0, 0.0, rao=((0.1, 1.0, 0.0), (2.0, 0.5, 90.0)))
    line = plumb(1000.0, 0.4, 4e6, 5000.0, 50)
    sea = sea_states.spectrum_of("bretschneider", 3.0, 9.0, 3.3)
    response, _ = respond(line, given, waves([2.0]), sea)
    assert response.motion[0, 0, 2] == pytest.approx(0.5j, rel=1e-4)


def test_waves_of_any_depth():
    """ω² = g k tanh(kh); deep down the motion is that of Airy, and none goes through the bed."""
    omega = np.array([0.05, 0.3, 1.0, 3.0])
    for depth in (5.0, 50.0, 4000.0):
        k = wave_numbers(omega, depth, GRAVITY)
        assert GRAVITY * k * np.tanh(k * depth) == pytest.approx(omega**2, rel=1e-10)
    places = np.array([[0.0, 0.0, 0.0], [30.0, 0.0, -20.0], [0.0, 0.0, -50.0]])
    flow = waves(omega, 50.0).velocity(places)
    assert flow[:, 2, 2] == pytest.approx(0.0, abs=1e-12)
    k = waves(omega, 50.0).number
    assert flow[:, 1, 0] == pytest.approx(
        omega * np.cosh(k * 30.0) / np.sinh(k * 50.0) * np.exp(-30j * k), rel=1e-10
    )
    assert flow[:, 0, 2] == pytest.approx(1j * omega, rel=1e-12)


def test_extremes_of_a_gaussian_process():
    """1000 crossings: √(2 ln 1000) = 3.717 deviations; e⁻¹ of it is not passed."""
    assert greatest_of(2.0, 10.0, 10_000.0) == pytest.approx(2.0 * 3.7169, rel=1e-4)
    margin = greatest_of(1.0, 10.0, 10_000.0)
    probability = passing_probability(margin, 1.0, 10.0, 10_000.0)
    assert probability == pytest.approx(1.0 - np.exp(-1.0), rel=1e-9)
    assert passing_probability(-1.0, 1.0, 10.0, 100.0) == 1.0
    assert sea_states.full_sea_period(4.0) == pytest.approx(10.03, abs=0.01)


def test_a_following_float_heaves_with_the_water():
    line = plumb(1000.0, 0.4, 4e6, 5000.0, 50)
    sea = sea_states.spectrum_of("bretschneider", 3.0, 9.0, 3.3)
    response, _ = respond(line, FOLLOWER, waves([0.5, 1.0]), sea)
    assert np.abs(response.motion[:, 0, 2]) == pytest.approx(1.0, rel=1e-4)
    free, _ = respond(line, replace(FOLLOWER, follows=False), waves([0.05]), sea)
    assert np.abs(free.motion[0, 0, 2]) == pytest.approx(1.0, rel=0.3)


def test_a_spectrum_over_radians_per_second(tmp_path):
    """Frequencies of a dataset in rad/s are told by their unit; the sea is the same."""
    sea = sea_states.spectrum_of("bretschneider", 0.5, 14.0, 3.3)
    given = dataset(lambda f: sea.density(2.0 * pi * f))
    turning = {"units": "rad s-1"}
    given = given.assign_coords(
        frequency=("frequency", 2.0 * pi * given["frequency"].data, turning)
    )
    given.to_netcdf(tmp_path / "sea.nc", engine="scipy")
    read = sea_states.measured_spectrum(tmp_path / "sea.nc")
    assert read.significant_height == pytest.approx(0.5, rel=5e-3)
    assert read.peak_period == pytest.approx(14.0, rel=0.03)


def test_a_spectrum_that_ends_at_its_peak_is_refused(tmp_path):
    rows = "".join(f"{f:.3f},{25.0 * f:.3f}\n" for f in np.linspace(0.05, 0.15, 11))
    (tmp_path / "cut.csv").write_text(f"frequency[Hz],density[m^2/Hz]\n{rows}")
    with pytest.raises(InputError, match="is cut off"):
        sea_states.measured_spectrum(tmp_path / "cut.csv")


def dataset(density, directions=0, units="m2 Hz-1"):
    """A spectrum of NDBC, or with directions of WAVEWATCH III, of two times."""
    import xarray as xr

    frequency = np.linspace(0.03, 1.5, 600)
    values = np.stack([0.25 * density(frequency), density(frequency)])
    if not directions:
        names, name = ("time", "frequency"), "spectral_wave_density"
    else:
        # spread over half of the directions; whatever the spread, its sum is the spectrum
        spread = np.r_[np.ones(directions // 2), np.zeros(directions - directions // 2)]
        spread /= spread.sum() * 2.0 * pi / directions
        values = values[:, :, None] * spread
        names, name = ("time", "frequency", "direction"), "efth"
    found = xr.Dataset({name: (names, values, {"units": units})})
    return found.assign_coords(frequency=("frequency", frequency, {"units": "Hz"}))


@pytest.mark.parametrize(("directions", "units"), [(0, "m2 Hz-1"), (24, "m2 s rad-1")])
def test_a_spectrum_in_netcdf(tmp_path, directions, units):
    """The higher of two times; over directions it is integrated, by their unit."""
    sea = sea_states.spectrum_of("bretschneider", 3.0, 8.0, 3.3)
    found = dataset(lambda f: sea.density(2.0 * pi * f) * 2.0 * pi, directions, units)
    found.to_netcdf(tmp_path / "sea.nc", engine="scipy")
    read = sea_states.measured_spectrum(tmp_path / "sea.nc")
    assert read.significant_height == pytest.approx(3.0, rel=2e-3)
    assert read.peak_period == pytest.approx(8.0, rel=0.02)
    omega = np.array([0.6, 0.8, 1.5])
    assert read.density(omega) == pytest.approx(sea.density(omega), rel=0.01)
    # what is solved for begins below the peak by a third at least, and not at nothing
    assert 0.02 * 0.785 < read.frequencies(50)[0] < 0.7 * 0.785


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.rename(spectral_wave_density="waves"), "no spectrum of waves"),
        (lambda d: d.drop_vars("frequency"), "no frequency dimension"),
        (lambda d: d * -1.0, "must not be negative"),
        (lambda d: d * np.nan, "every spectrum in the file has gaps"),
        (lambda d: d * 1e4, "the maximum wave height is"),
    ],
)
def test_netcdf_that_is_no_spectrum(tmp_path, change, message):
    sea = sea_states.spectrum_of("bretschneider", 3.0, 8.0, 3.3)
    found = change(dataset(lambda f: sea.density(2.0 * pi * f) * 2.0 * pi))
    found.to_netcdf(tmp_path / "sea.nc", engine="scipy")
    with pytest.raises(InputError, match=message):
        sea_states.measured_spectrum(tmp_path / "sea.nc")


def test_the_end_of_a_heavy_chain_rests_on_no_element(tmp_path):
    """Below a float the tension varies fast along a chain; coarse and fine elements agree."""
    (tmp_path / "buoy.yaml").write_text(HEAVY)
    mooring = load(tmp_path / "buoy.yaml")
    solution = mooring.leg.equilibrium()
    sea, buoy = (
        sea_states.spectrum_of("bretschneider", 0.5, 3.0, 3.3),
        buoy_of(mooring.leg, solution, False),
    )
    found = []
    for longest in (1.6, 0.1):
        line = lumped_line(mooring.leg, solution, longest)
        response, _ = respond(line, buoy, waves(sea.frequencies(32), 80.0), sea)
        found.append(response.moments(line.upper_ends(response.pull))[0])
    assert found[0] == pytest.approx(found[1], rel=0.01)


HEAVY = """\
name: Coastal buoy
environment: {depth: 80 m, current: {speed: 0.3 m/s, toward: 90 deg}}
line:
  - {use: buoy}
  - {use: chain, length: 5 m}
  - {use: nylon, length: 60 m}
  - {use: block}
components:
  buoy: {kind: cylinder, role: float, diameter: 1.6 m, length: 1.2 m, mass: 700 kg,
         volume: 2.4127 m^3, hull: cylinder}
  chain: {kind: chain, diameter: 16 mm, mass: 5.6 kg/m}
  nylon: {kind: cable, diameter: 20 mm, weight: 0.3 N/m, mass: 0.25 kg/m, stiffness: 12 kN}
  block: {kind: anchor, weight: 30 kN}
"""


def test_a_float_displaces_what_it_weighs_and_what_pulls_it_down(tmp_path):
    """700 kg and the line's pull, 2.56 kN: as much as the cylinder does at its draft."""
    (tmp_path / "buoy.yaml").write_text(HEAVY)
    mooring = load(tmp_path / "buoy.yaml")
    buoy = buoy_of(mooring.leg, mooring.leg.equilibrium(), False)
    assert buoy.displaced == pytest.approx(1025.0 * pi * 0.8**2 * buoy.draft, rel=1e-3)


def test_a_spring_turns_by_what_moves_it_sideways_alone():
    """0.02 m across at the upper end of 4 m, and 0.03 m along it, which is no turn."""
    line = plumb(8.0, 1.0, 1e6, 1e3, 2)
    motion = np.zeros((1, 3, 3), complex)
    motion[0, 0] = [0.02, 0.0, 0.03]
    assert line.turned(motion)[0] == pytest.approx(np.array([[-0.005, 0.0, 0.0], [0.0] * 3]))


def test_drag_goes_with_the_density_and_a_rope_that_floats_is_slackest_on_top(tmp_path):
    floats = HEAVY.replace("weight: 0.3 N/m", "buoyancy: 5 N/m, cn: 1.2")
    lines = []
    for density in (1000.0, 1100.0):
        text = floats.replace("depth: 80 m", f"depth: 80 m, density: {density} kg/m^3")
        (tmp_path / "buoy.yaml").write_text(text)
        mooring = load(tmp_path / "buoy.yaml")
        lines.append(lumped_line(mooring.leg, mooring.leg.equilibrium(), 1.0))
    nylon = 0.5 * 1000.0 * 1.2 * 0.02 * 60.0
    below = lines[0].piece_node[2] + 1
    assert lines[0].across_drag[below:].sum() == pytest.approx(nylon, rel=0.02)
    assert lines[1].across_drag[below:].sum() == pytest.approx(1.1 * nylon, rel=0.02)
    sea = sea_states.spectrum_of("bretschneider", 0.5, 4.0, 3.3)
    (state,) = analyse(mooring.leg, [sea], 90.0).states
    rope = state.components[2]
    assert rope.least == rope.tension_min < rope.tension_mean
    # its lower end is pulled by 5 N/m over 60 m more, and by what the waves move below the middle
    assert 300.0 < rope.greatest - rope.tension_max < 400.0


@pytest.mark.parametrize("order", [0, 1, 2])
def test_bessel_functions_are_those_of_scipy(order):
    x = np.concatenate([[0.0], np.geomspace(1e-9, 1.0, 40), np.linspace(0.0, 200.0, 2001)])
    assert bessel(order, x) == pytest.approx(jv(order, x), rel=1e-12, abs=1e-14)
