"""Parse the formulas of problem files into functions, which may depend on the depth `H`."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

from calm.errors import InputError, Problem, one_line
from calm.exchange.cbl.words import SourceLine, Token, tokens_of

Formula: TypeAlias = Callable[[Mapping[str, float]], float]
"""Function that evaluates a formula, given the values of its names."""

_DEEPEST = 40  # nesting depth of parentheses
_FUNCTIONS: dict[str, tuple[int, Callable[..., float]]] = {
    "sin": (1, math.sin), "cos": (1, math.cos), "tan": (1, math.tan), "asin": (1, math.asin),
    "acos": (1, math.acos), "atan2": (2, math.atan2), "sinh": (1, math.sinh),
    "cosh": (1, math.cosh), "tanh": (1, math.tanh), "exp": (1, math.exp), "log": (1, math.log),
    "log10": (1, math.log10), "sqrt": (1, math.sqrt), "pow": (2, math.pow),
    "hypot": (2, math.hypot), "floor": (1, lambda x: float(math.floor(x))),
    "ceil": (1, lambda x: float(math.ceil(x))), "fmod": (2, math.fmod), "fabs": (1, abs),
}  # fmt: skip
_LOGICAL: dict[str, Callable[[Formula, Formula], Formula]] = {
    "||": lambda left, right: lambda at: float(bool(left(at)) or bool(right(at))),
    "&&": lambda left, right: lambda at: float(bool(left(at)) and bool(right(at))),
}
"""Operators whose right operand is not evaluated if the left operand decides the result."""

_BINARY: dict[str, Callable[[float, float], float]] = {
    "|": lambda a, b: float(int(a) | int(b)),
    "^": lambda a, b: float(int(a) ^ int(b)),
    "&": lambda a, b: float(int(a) & int(b)),
    "==": lambda a, b: float(a == b), "!=": lambda a, b: float(a != b),
    "<": lambda a, b: float(a < b), ">": lambda a, b: float(a > b),
    "<=": lambda a, b: float(a <= b), ">=": lambda a, b: float(a >= b),
    "<<": lambda a, b: float(int(a) << min(int(b), 64)),
    ">>": lambda a, b: float(int(a) >> int(b)),
    "+": lambda a, b: a + b, "-": lambda a, b: a - b,
    "*": lambda a, b: a * b, "/": lambda a, b: a / b, "%": lambda a, b: float(int(a) % int(b)),
}  # fmt: skip
_LEVELS = ("||", "&&", "|", "^", "&", "== !=", "< > <= >=", "<< >>", "+ -", "* / %")
"""Binary operators by precedence, from the lowest level to the highest."""

_UNARY: dict[str, Callable[[float], float]] = {
    "-": lambda a: -a, "+": lambda a: a, "!": lambda a: float(not a), "~": lambda a: float(~int(a)),
}  # fmt: skip


@dataclass
class TokenStream:
    """Stream of tokens; `at` is the index of the next token."""

    tokens: list[Token]
    at: int = 0

    @property
    def next(self) -> Token:
        """The next token, without consuming it."""
        return self.tokens[self.at]

    def ahead(self, count: int) -> Token:
        """Return the token `count` places after the next token, without consuming any token."""
        return self.tokens[min(self.at + count, len(self.tokens) - 1)]

    def take(self) -> Token:
        """Consume and return the next token."""
        token = self.next
        self.at = min(self.at + 1, len(self.tokens) - 1)
        return token

    def is_next(self, *signs: str) -> bool:
        """True if the next token is one of the given symbols."""
        return self.next.kind == "sign" and self.next.text in signs

    def accept(self, sign: str) -> bool:
        """Consume the next token if it is the given symbol; return whether it was consumed."""
        return self.is_next(sign) and bool(self.take())

    def expect(self, sign: str) -> None:
        """Consume the next token; raise InputError if it is not the given symbol."""
        if not self.accept(sign):
            raise self.next.refuse(f"`{sign}` is missing before `{self.next.text}`")


class UnknownNameError(InputError):
    """Error raised if a formula contains undefined names; `names` lists them."""

    def __init__(self, token: Token, names: Sequence[str]) -> None:
        self.names = tuple(names)
        message = (
            "`{0}` is neither a number nor a known name; if it is a macro, define it by -D {0}=…"
        )
        place = token.path, token.line, token.column
        super().__init__([Problem(*place, one_line(message.format(name))) for name in names])


@dataclass
class Expression:
    """Parsed formula, with the names that it contains and its first token."""

    formula: Formula
    names: frozenset[str]
    token: Token

    def at(self, **values: float) -> float:
        """Evaluate the formula for given values of the names in it.

        Raises
        ------
        UnknownNameError
            The formula contains names without a value.
        InputError
            The formula has no value, for example because it divides by zero.
        """
        unknown = sorted(self.names - values.keys())
        if unknown:
            raise UnknownNameError(self.token, unknown)
        try:
            value = self.formula(values)
        except (ArithmeticError, ValueError, TypeError, RecursionError):
            value = math.nan
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            raise self.token.refuse("the formula has no value")
        return float(value)


def constant(text: str) -> float:
    """Evaluate a formula that contains no names."""
    words = TokenStream(list(tokens_of([SourceLine(text, "", 1)])))
    value = read_expression(words).at()
    if words.next.kind != "end":
        raise words.next.refuse(f"`{words.next.text}` after the formula is not understood")
    return value


def read_expression(words: TokenStream) -> Expression:
    """Parse the formula at the start of the tokens; raise InputError if the formula is invalid."""
    token, names = words.next, set[str]()
    formula = _FormulaParser(words, names).choice(0)
    return Expression(formula, frozenset(names), token)


class _FormulaParser:
    def __init__(self, words: TokenStream, names: set[str]) -> None:
        self._words = words
        self._names = names

    def choice(self, depth: int) -> Formula:
        if depth > _DEEPEST:
            raise self._words.next.refuse("parentheses are nested too deeply")
        condition = self._binary(0, depth)
        if not self._words.accept("?"):
            return condition
        yes = self.choice(depth + 1)
        self._words.expect(":")
        no = self.choice(depth + 1)
        return lambda at: yes(at) if condition(at) else no(at)

    def _binary(self, level: int, depth: int) -> Formula:
        if level == len(_LEVELS):
            return self._unary(depth)
        left = self._binary(level + 1, depth)
        while self._words.is_next(*_LEVELS[level].split()):
            # a `+` before a key or the end marks a periodic table, not an addition
            if self._words.is_next("+") and self._words.ahead(1).kind in ("key", "end"):
                break
            left = _joined(self._words.take().text, left, self._binary(level + 1, depth))
        return left

    def _unary(self, depth: int) -> Formula:
        if depth > _DEEPEST:
            raise self._words.next.refuse("too many consecutive signs")
        if not self._words.is_next(*_UNARY):
            return self._value(depth)
        operation = _UNARY[self._words.take().text]
        of = self._unary(depth + 1)
        return lambda at: operation(of(at))

    def _value(self, depth: int) -> Formula:
        token = self._words.take()
        if token.kind == "number":
            return lambda at: token.number
        if token.kind == "sign" and token.text == "(":
            inner = self.choice(depth + 1)
            self._words.expect(")")
            return inner
        if token.kind != "name":
            raise token.refuse(f"a number is missing before `{token.text}`")
        if "/" in token.text:  # names may contain this sign; here it divides
            head, _, rest = token.text.partition("/")
            more = list(tokens_of([SourceLine(f"/{rest}", token.path, token.line)]))
            self._words.tokens[self._words.at : self._words.at] = more[:-1]
            token = replace(token, text=head)
        if token.text.lower() in _FUNCTIONS:
            return self._call(token, depth)
        if token.text.lower() == "pi":
            return lambda at: math.pi
        name = token.text
        self._names.add(name)
        return lambda at: at[name]

    def _call(self, token: Token, depth: int) -> Formula:
        count, function = _FUNCTIONS[token.text.lower()]
        self._words.expect("(")
        arguments = [self.choice(depth + 1)]
        while self._words.accept(","):
            arguments.append(self.choice(depth + 1))
        self._words.expect(")")
        if len(arguments) != count:
            raise token.refuse(f"`{token.text}` takes {count} values, not {len(arguments)}")
        return lambda at: function(*(each(at) for each in arguments))


def _joined(sign: str, left: Formula, right: Formula) -> Formula:
    if sign in _LOGICAL:
        return _LOGICAL[sign](left, right)
    operation = _BINARY[sign]
    return lambda at: operation(left(at), right(at))
