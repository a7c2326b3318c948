"""Solver key `strumming:`: increase of the drag coefficient Cn of cables due to vibration."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal, cast, get_args

from pydantic import BeforeValidator, ConfigDict, Discriminator, Tag, ValidationInfo

from calm.errors import nearest, not_among, shown
from calm.files.definition import COEFFICIENT, Model, QuantityField, described
from calm.physics.strumming import BourgetMarichal
from calm.units import QuantityError

_NUMBER = QuantityField("number")
_FACTOR = QuantityField("number", above=0)
_RAISED = QuantityField("number", at_least=1)
"""A strumming factor, at least 1: a vibrating cable sweeps a larger width and has a higher drag."""
_RESTING_CN = QuantityField("number", above=0, at_most=BourgetMarichal.ceiling)

AmplitudeName = Literal["vandiver", "blevins", "skop-griffin"]
_Name = Literal["none", "bourget-marichal", AmplitudeName]


class StrummingFactor(Model):
    """A factor on the Cn of every cable."""

    factor: Annotated[float, _RAISED] = described("factor applied to the Cn of every cable", 1.5)


class ConstantCn(Model):
    """A fixed Cn that replaces the value of every cable; 1.8 to 1.9 is usual for towed cables."""

    cn: Annotated[float, COEFFICIENT] = described("drag coefficient across the axis", 1.2)


class BourgetMarichalKeys(Model):
    """Strumming model for towed cables by Bourget & Marichal.

    The vibration amplitude a of a cable with the diameter D follows from a/D = a1 + b1 φ + c1 φ²,
    with the angle φ between cable and flow in degrees. The coefficient c0 is Cn without vibration.
    The defaults of the coefficients are those of `calm.physics.strumming.BourgetMarichal`.
    """

    model_config = ConfigDict(json_schema_extra={"required": ["model"]})

    model: Literal["bourget-marichal"] = described(
        "the law", "bourget-marichal", default="bourget-marichal"
    )
    a1: Annotated[float, _NUMBER] = described(
        "vibration amplitude / cable diameter = a1 + b1 φ + c1 φ², with the angle φ between cable "
        "and flow; a1 is the value for φ = 0",
        0.45,
        default=BourgetMarichal.a1,
    )
    b1: Annotated[float, _NUMBER] = described(
        "coefficient of φ (see `a1`), per degree", 0.01, default=BourgetMarichal.b1
    )
    c1: Annotated[float, _NUMBER] = described(
        "coefficient of φ² (see `a1`), per square degree", 0.0, default=BourgetMarichal.c1
    )
    c0: Annotated[float, _RESTING_CN] = described(
        "Cn of the cable at rest", 1.2, default=BourgetMarichal.rest
    )
    strouhal: Annotated[float, _FACTOR] = described(
        "(strumming frequency × cable diameter) / flow speed normal to the cable",
        0.2,
        default=BourgetMarichal.strouhal,
    )


@dataclass(frozen=True)
class AmplitudeModel:
    """Model that computes the increase of Cn from the vibration amplitude of each segment."""

    name: Annotated[AmplitudeName, described("the law", "vandiver")]


_FORMS: Mapping[str, type[Model]] = {
    "factor": StrummingFactor,
    "cn": ConstantCn,
    "model": BourgetMarichalKeys,
}
"""Mappings allowed under `strumming:`, by their required key."""


def _forms_in(value: dict[str, object]) -> list[str]:
    exact = [form for form in _FORMS if form in value]
    return exact or [form for key in value if (form := nearest(key, _FORMS))]


def _written_out(value: object, info: ValidationInfo) -> object:
    if value is None:
        raise QuantityError("has no value")
    law = value.get("model") if isinstance(value, dict) else value
    if law == "bourget-marichal" and info.context and not info.context["towed"]:
        raise ValueError(
            "`bourget-marichal` is only for towed cables; "
            f"for a mooring, use one of {', '.join(get_args(AmplitudeName))}"
        )
    if isinstance(value, dict):
        return _one_form(value)
    if value == "none":
        return None
    if value == "bourget-marichal":
        return BourgetMarichalKeys()
    if value in get_args(AmplitudeName):
        return AmplitudeModel(cast("AmplitudeName", value))
    text = shown(value)
    try:
        offer = f"{{factor: {_FACTOR.read(text):g}}}"
    except QuantityError:
        offer = None
    raise ValueError(not_among("strumming", text, get_args(_Name), offer))


def _one_form(value: dict[str, object]) -> dict[str, object]:
    forms = _forms_in(value)
    if not forms:
        raise ValueError("`strumming` needs `factor`, `cn`, or `model: bourget-marichal`")
    if len(forms) > 1:
        given = " and ".join(f"`{form}`" for form in forms)
        raise ValueError(f"`strumming` has {given}, which exclude each other")
    law = value.get("model")
    if law in get_args(AmplitudeName):
        raise ValueError(f"`{law}` takes no values; write `strumming: {law}`")
    return value


def _form(value: object) -> str:
    if isinstance(value, dict):
        # messages about mistakes find the keys by the name of the class
        return _FORMS[_forms_in(value)[0]].__name__
    return type(value).__name__


Strumming = Annotated[
    Annotated[StrummingFactor, Tag("StrummingFactor")]
    | Annotated[ConstantCn, Tag("ConstantCn")]
    | Annotated[BourgetMarichalKeys, Tag("BourgetMarichalKeys")]
    | Annotated[AmplitudeModel, Tag("AmplitudeModel")]
    | Annotated[None, Tag("NoneType")],
    Discriminator(_form),
    BeforeValidator(
        _written_out,
        json_schema_input_type=_Name | StrummingFactor | ConstantCn | BourgetMarichalKeys,
    ),
]
"""Type of the key `strumming:`; None means no strumming."""
