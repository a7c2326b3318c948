"""Design rules as text: title, quantity, checked value, limit and source.

The functions that apply the rules are in `calm.checks`.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class RuleText:
    """Texts that describe one rule of the design check.

    Attributes
    ----------
    quantity : name of the values in `calm.quantities`; "" for a rule without values
    judges : description of the checked value
    limit : sentences that describe the limit, and the finding if the value is beyond the limit
    source : source of the rule and of its default limit
    unseen : reason why the rule cannot check batch profiles; "" if it can
    figures : component keys that the rule needs
    has_ratio : whether the ratio of value and limit is meaningful
    """

    title: str
    quantity: str
    judges: str
    limit: str
    source: str
    unseen: str = ""
    figures: tuple[str, ...] = ()
    has_ratio: bool = True


_WAVES = "`calm check` checks the waves of each environment"
_ONCE = "`calm check` checks this once for each mooring"

RULES = {
    "equilibrium": RuleText("Equilibrium", "",
        "whether the mooring has an equilibrium; if not, the finding gives the status and advice "
        "of the solver",
        "",
        "A mooring without an equilibrium cannot be checked"),
    "current": RuleText("Current", "speed",
        "the strongest current of all environments, and the depth range of each current profile",
        "There is a warning if the strongest current is below 0.2 m/s, or below 0.9 times the "
        "strongest current of a record from which a profile was taken. There is a warning for an "
        "environment with a current below 1/50 of the strongest current. There is also a warning "
        "if a profile leaves a gap at the surface or at the seabed that exceeds both 25 m and a "
        "tenth of the depth",
        "DNV-RP-C205: wind drives a surface current of 0.015 to 0.03 times its speed, up to 0.2 "
        "m/s at 7 m/s",
        "in a batch, the record supplies the currents"),
    "drag-coefficient": RuleText("Drag coefficient", "",
        "drag coefficients of spheres and cylinders at Reynolds numbers above 2e5 or, with "
        "`drag: reynolds`, beyond the end of the drag curve",
        "There is a warning if the drag curve of a smooth shape increases the knockdown, or the "
        "offset of a surface mooring, by more than 5 %. Otherwise the effect is reported, but not "
        "judged",
        "Constant coefficients are valid up to 2e5; above this number the drag of smooth shapes "
        "falls",
        "the profiles of a record are solved with one law of drag"),
    "environment": RuleText("Environment", "",
        "possible but unusual values of an environment: directions that look like radians; a "
        "current opposite to the currents at the levels above and below; a current that increases "
        "down to the seabed, or is stronger than any current measured in deep water; a density not "
        "found in any sea; a tidal range of more than 20 m; wind of more than 75 m/s; a "
        "storm current that is less than half the ordinary current at some levels; no `wind` "
        "although a surface float has a `wind_area`; fresh or brackish water in which the buoyancy "
        "of a float without `mass` and `volume` is too high",
        "There is a warning for each of these",
        "CALM's own limits, from ranges found at sea and common typing errors",
        "`calm check` compares the environments with each other"),
    "missing": RuleText("Missing values", "",
        "values that rules need but a component lacks; there is one finding for each missing "
        "value of a component",
        "The result is unknown",
        "The finding lists the rules that need the value, and the pieces concerned",
        _ONCE),
    "strength": RuleText("Strength", "load",
        "maximum tension of every piece; the top piece and the anchor are checked only if they "
        "have a load limit",
        "The tension must not exceed the working load, nor the breaking load divided by "
        "`safety_factor` (3 for steel, 5 for synthetics, 5 for all pieces of a surface mooring). "
        "For a synthetic rope with a known breaking load, only the breaking load counts, since "
        "rope tables give working loads for lifting",
        "UFC 4-159-03, table 3-7, gives a factor of 3 for chain and wire; oceanographers use a "
        "third to a fifth of the breaking load", figures=("working_load", "breaking_load")),
    "release-load": RuleText("Release load", "load",
        "maximum tension of every release, and the tension below the release when it opens",
        "The tension must not exceed the limit of the rule `strength`. When the release opens, "
        "the tension must not exceed its `opening_load`, if this is given",
        "The manufacturer gives the static load and the opening load",
        figures=("working_load", "opening_load")),
    "clamp-grip": RuleText("Clamp grip", "load",
        "load on every clamp from its weight in water and its drag, in the current, in the anchor "
        "drop and in the ascent",
        "The load must not exceed the `grip` of the clamp or, without a `grip`, its "
        "`breaking_load`. It is not judged if neither is given",
        "The manufacturer of the clamp gives these loads",
        "the result does not contain the current at each clamp", figures=("grip",)),
    "profiler": RuleText("Profiler on its wire", "load",
        "wire tension, obstacles on the wire, and the force that the profiler needs to travel; "
        "these are checked with the profiler at both stops and at the largest inclination of the "
        "wire",
        "The tension must be at least `minimum_tension` (2224 N), the force must not exceed "
        "`drive_force`, and no clamp may be between the stops. There is a warning if the diameter "
        "of the wire is not between 6.35 and 9.53 mm, or if a profile takes more than 6.4 h",
        "The limits are from the user manual of the McLane Moored Profiler",
        "the profiles of a record are solved with the profiler at its upper stop",
        figures=("drive_force",)),
    "strength-steps": RuleText("Strength steps", "load",
        "strength of every piece, compared with the cables above and below it",
        "There is a warning if the allowable load of the piece is less than half the allowable "
        "load of the weaker cable, and the tension in the piece is more than half of the piece's "
        "allowable load. Estimated loads are ignored",
        "CALM's own limit: a piece should have at least half the strength of the adjacent cables",
        "the strengths of adjacent pieces do not change with the current"),
    "tilt": RuleText("Tilt", "tilt",
        "tilt of every instrument, release and clamp",
        "The tilt must not exceed `max_tilt` of the component, nor `maximum_tilt` if this is "
        "given. There is a warning above `warn_tilt`",
        "The manufacturer gives the limit: RCM 27° (BODC), single-point Doppler 30°, ADCP 15 to "
        "20°, release 45°, sediment trap 10°", figures=("max_tilt",)),
    "depth-rating": RuleText("Depth rating", "depth",
        "depth of every part in the current; a surface float is checked only if it has a rating",
        "The depth must not exceed `depth_rating` minus `rating_margin` (100 m, but at most half "
        "of the rating)",
        "The manufacturer gives the rating; the margin allows for a stronger current than "
        "expected", figures=("depth_rating",)),
    "top-depth": RuleText("Top depth", "depth",
        "minimum depth of the top of a subsurface line, also at low water",
        "A depth of less than `minimum_top_depth` is a failure. If `minimum_top_depth` is not "
        "given, there is a warning at less than 10 m",
        "CALM's own limit, to stay clear of waves, hulls and nets"),
    "planned-depth": RuleText("Planned depth", "depth",
        "difference between the planned depth and the depth in still water, for every piece and "
        "clamp with a `planned_depth` or a depth in its label",
        "There is a warning if the difference exceeds both `planned_depth_warning` (10 m) and 2 % "
        "of the planned depth. The difference is a failure if it also exceeds "
        "`planned_depth_limit` (10 %) of the planned depth. Parts without a planned depth are not "
        "checked",
        "CALM's own limit. A large difference suggests an error in a length or in the water depth",
        _ONCE),
    "stretch": RuleText("Stretch", "length",
        "stretch of synthetic ropes without `stiffness` or `elongation`; load under which a rope "
        "with `length_at` is measured",
        "The result is unknown if the rope may stretch by more than 2 % of the water depth; the "
        "stretch is estimated from published stiffnesses. There is a warning if the rope is "
        "measured under more than its working load. If the working load is unknown, the limit is "
        "a fifth of the breaking load",
        "CALM's own limit: soundings have a similar error, and ropes are measured under a small "
        "load",
        "`calm check` checks this in each environment"),
    "fish-bite": RuleText("Fish bite", "depth",
        "minimum depth of every synthetic rope, in more than 200 m of water and less than 60° "
        "from the equator",
        "There is a warning if the rope reaches above `fishbite_depth` (1000 m)",
        "Berteaux, Prindle & May, OCEANS '87: far offshore, fish attack ropes from the "
        "surface to 1000 m and deeper. The limits on water depth and latitude are CALM's own",
        "ropes are bitten over months, not during one profile", has_ratio=False),
    "knockdown": RuleText("Knockdown", "knockdown",
        "knockdown of the top",
        "The knockdown must not exceed `maximum_knockdown`, if this is given",
        "The design's own `maximum_knockdown`"),
    "excursion": RuleText("Excursion", "offset",
        "horizontal offset of the top",
        "The offset must not exceed `maximum_excursion`, if this is given",
        "The design's own `maximum_excursion`"),
    "anchor-weight": RuleText("Anchor weight", "load",
        "weight of the anchor in water",
        "The weight must be at least `anchor_factor` (1.5) times (V + H / friction), with a "
        "friction coefficient of 0.6",
        "Dewey, Mooring Design & Dynamics: weight in water ≥ 1.5 (V + H/0.6)",
        figures=("weight", "density")),
    "anchor-uplift": RuleText("Anchor uplift", "load",
        "V, the vertical load on the anchor",
        "V must not exceed the weight of the anchor in water / `anchor_factor`",
        "Dewey's rule, vertical part: V ≤ weight in water / 1.5", figures=("weight", "density")),
    "anchor-sliding": RuleText("Anchor sliding", "load",
        "H, the horizontal load on the anchor",
        "H must not exceed friction × (weight of the anchor in water / `anchor_factor` − V)",
        "Dewey's rule, horizontal part: H ≤ friction (weight in water / 1.5 - V), with a friction "
        "coefficient of 0.6 for a deadweight", figures=("weight", "density")),
    "slack": RuleText("Minimum tension", "load",
        "minimum tension of each wire and rope above the release; line on the seabed is exempt; "
        "the default limits do not apply if the line above the release is at most 50 m long",
        "The tension must be at least `minimum_tension`: 500 N for wire, 300 N for rope. A piece "
        "with `slack: allowed` is exempt",
        "Mooring groups keep a tension of 50 to 100 kgf above the release; no limit is published, "
        "so CALM sets its own limits"),
    "wave-strength": RuleText("Strength in waves", "load",
        "most probable maximum tension of every piece in 3 h of the sea state in `waves:`",
        "The tension must not exceed the working load, nor the breaking load divided by "
        "`waves_safety_factor` (1.67); the loads are those of the rule `strength`. The state is "
        "unknown for a surface mooring without `waves:`",
        "API RP 2SK: the factor on the breaking strength of the intact mooring is 1.67, with "
        "tensions from a dynamic analysis",
        _WAVES, figures=("working_load", "breaking_load")),
    "wave-slack": RuleText("Slack in waves", "load",
        "most probable minimum tension of every piece in 3 h of the sea state in `waves:`",
        "The tension must be above 0. A piece with `slack: allowed` is exempt",
        "A slack line takes snap loads as it tightens, and the linear wave model is not valid "
        "then",
        _WAVES),
    "fatigue": RuleText("Fatigue in waves", "life",
        "fatigue life of every piece below the float in the sea states of `waves: scatter:`",
        "The life must be at least `fatigue_factor` (3) times `service_time` (365 days). It is "
        "not judged without a table of sea states, and unknown without a published fatigue curve",
        "Dirlik 1985 and Miner's sum give the damage, with curves of DNV-OS-E301 (chain, "
        "polyester) and API RP 2SK (wire); the life must be three times the service time",
        _WAVES),
    "reserve": RuleText("Reserve buoyancy", "used_buoyancy",
        "unused share of the surface float's buoyancy",
        "The share must be at least `minimum_reserve` (0.3)",
        "Dewey: a float submerges if all its buoyancy is in use; waves need a reserve"),
    "freeboard": RuleText("Freeboard", "freeboard",
        "freeboard of the surface float",
        "The freeboard must be above 0",
        "The hull of a surface float must extend above the water",
        "the result does not contain the draft of the float"),
    "watch-circle": RuleText("Watch circle", "offset",
        "radius of the watch circle, √(L² − h²), with the stretched length L and the water depth "
        "h above the top of the anchor",
        "The radius must not exceed `maximum_excursion`; it is not judged if `maximum_excursion` "
        "is not given",
        "The worst case is √(L² - h²), with the water depth h above the anchor; the limit is the "
        "design's own `maximum_excursion`",
        "the result does not contain the stretched length of the line"),
    "scope": RuleText("Scope", "scope",
        "ratio of cut length to water depth",
        "There is no limit; the scope is only reported",
        "CALM reports the scope without a limit",
        "the scope is only reported, and has no limit"),
    "as-deployed": RuleText("As deployed", "depth",
        "top depth of the upright line with the water depth and lengths in `deployed`, compared "
        "with the top depth in the design",
        "There is a warning if the difference exceeds the error of a sounding, √((1 m)² + (2.3 % "
        "of the depth)²)",
        "IHO S-44, order 2, gives the maximum error of a sounding, at the 95 % level",
        _ONCE),
    "figures": RuleText("Component values", "",
        "values of pieces and clamps that are impossible for their size and material: buoyancy, "
        "mass, density, stiffness, strength, depth rating, drag coefficients",
        "Such a value is a failure. There is only a warning if `warn_tilt` exceeds `max_tilt`, if "
        "an instrument, release or connector floats, or if the `wind_area` is unusual for the "
        "displacement of the float. The result is unknown if the line overrides a value with a "
        "more favourable value but gives no `source`, or if a `material` is unknown or "
        "contradicts the `name`",
        "The limits are those of `calm catalog check`",
        _ONCE),
    "release-present": RuleText("Release", "",
        "whether a piece of a subsurface line has `role: release`, and whether it frees the line",
        "The result is unknown if no piece has this role, or if the release is a clamp. It is also "
        "unknown if the name of the release is that of a shackle, swivel, rope or similar part. "
        "There is a failure if no buoyancy is above the release. There is a warning if the release "
        "is less than 1 m above the anchor, or if a float is below the release. There is also a "
        "warning for a single release in more than 100 m of water. A name or label with a word "
        "such as dual, twin or pair counts as two releases",
        "CALM's own rule: a line that will be recovered needs a release",
        _ONCE),
    "hardware": RuleText("Hardware", "",
        "pieces of the line with `role: connector`",
        "There is a warning if the line has none",
        "CALM's own rule: connectors have weight, drag and a strength",
        _ONCE),
    "joints": RuleText("Joints", "",
        "whether there is a piece with `role: connector` wherever pieces of different kinds (wire, "
        "chain, rigid) meet; wires with a `termination` and spliced ropes need no connector",
        "There is one warning for all joints of the line, and no warning for a line without any "
        "hardware",
        "CALM's own rule: a shackle that is not listed is neither bought nor checked",
        _ONCE),
    "clamp-place": RuleText("Clamp positions", "",
        "clamps that overlap each other, or extend beyond the end of their cable or chain",
        "There is a failure if the overlap, or the part beyond the end, is longer than 5 cm",
        "Two parts cannot be in the same place",
        _ONCE),
    "serials-and-dates": RuleText("Serial numbers and dates", "",
        "rows with the same label, except connectors and anchors; items of one component with the "
        "same serial number; release codes without a release in the line; releases with the same "
        "codes; batteries that run out before the deployment or the calibration; calibrations "
        "after the deployment; a `revision` of the document that differs from the last revision "
        "in `history`; revisions that occur twice; revisions that are not in order of date",
        "There is a warning for each of these",
        "CALM's own rule: the deck sheets and the labels must agree",
        _ONCE),
    "swivel": RuleText("Swivel", "",
        "steel wire that ends at a float, with no chain or rope between them",
        "There is a warning, unless there is a swivel between them or at the other end of the "
        "wire, or the wire is torque-balanced. Whether it is torque-balanced is read from "
        "`torque_balanced` or, without this key, from the name, material or note of the wire",
        "CALM's own rule: if a wire twists under load, it kinks when the load comes off",
        _ONCE),
    "metals": RuleText("Dissimilar metals", "potential",
        "contacts of metals (by `material`) between adjacent pieces, or between a piece and its "
        "clamp, if neither part is `insulated`; clamps are insulated by default",
        "There is a warning if the potential difference in sea water is above 0.2 V",
        "Professional Boatbuilder 100, 2006, gives the galvanic series in sea water; Pantaenius "
        "gives a limit of 0.15 to 0.2 V in harsh surroundings",
        _ONCE, has_ratio=False),
    "backup": RuleText("Back-up buoyancy", "load",
        "net buoyancy of the section with the release, after the worst possible break of the line "
        "or loss of a float",
        "The net buoyancy must be at least `backup_margin` (0.1) times the weight lifted, and at "
        "least the drag at `minimum_rise_speed`. There is a warning for a surface mooring without "
        "floats below its buoy. A line with a single float, at most 50 m above the release, is not "
        "judged; this exception is CALM's own",
        "URI GSO mooring program: if any one link breaks, everything above the release still "
        "floats; CALM itself sets the margin",
        _ONCE),
    "launch-strength": RuleText("Strength during launch", "load",
        "maximum tension of every piece during the anchor drop",
        "The tension must not exceed the working load times `launch_working_factor` (1), nor the "
        "breaking load divided by `launch_safety_factor` (2); the loads are those of the rule "
        "`strength`",
        "As in the URI GSO program, the anchor falls at terminal speed; the limits are the "
        "working load and half the breaking load",
        _ONCE, figures=("working_load", "breaking_load")),
    "launch-speed": RuleText("Speed at touchdown", "speed",
        "speed of the anchor at touchdown",
        "There is a warning above 2.5 m/s",
        "CALM's own limit: an anchor that falls faster may bury itself or break the equipment "
        "attached to it",
        _ONCE, figures=("kt",)),
    "recovery": RuleText("Rise speed", "speed",
        "rise speed after release, for a line with a release or with its top below the surface",
        "The speed must be at least `minimum_rise_speed` (0.3 m/s). There is a warning below 0.7 "
        "m/s and above 3 m/s",
        "CALM's own limits: below 0.3 m/s a rise is uncertain, below 0.7 m/s it is slow; above 3 "
        "m/s floats breach and the line may loop",
        _ONCE),
    "tangling": RuleText("Tangling", "",
        "parts that overtake the parts ahead of them during the descent or the ascent, so that the "
        "line forms loops of 2 m or more",
        "There is a warning",
        "CALM's own rule: parts that overtake others may tangle with them",
        _ONCE),
}  # fmt: skip
"""All rules by id, in the order of the report."""

ACCEPTABLE = tuple(name for name in RULES if name != "equilibrium")
"""Rules allowed in `checks: accept:`. Without an equilibrium there are no findings to accept."""

LOADED = ("strength", "release-load", "clamp-grip", "wave-strength", "launch-strength", "missing")
"""Rules for which an accepted finding may state a maximum accepted tension."""
