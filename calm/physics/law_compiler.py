"""Translation of the physics functions ("laws") to LLVM instructions.

A law uses only numbers, named tuples, sequences of numbers or named tuples, and functions of
`math`. All types follow from the arguments of the law. Operations keep their order and their
meaning in Python. Indices are not checked. Named tuples are passed by address, since no law changes
a named tuple.
"""

import ast
import builtins
import math
import operator
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from calm.physics.law_instructions import (
    ArrayView,
    Global,
    Held,
    Instructions,
    Made,
    Number,
    number_of,
    row_of,
)
from calm.physics.law_kinds import (
    FROM_MATH,
    NOTHING,
    REAL,
    TRUTH,
    WHOLE,
    Array,
    Row,
    common,
    size_of,
    wanted_by,
)

Law = Callable[..., Any]

INTRINSIC = {"sqrt": "llvm.sqrt.f64", "copysign": "llvm.copysign.f64"}
OF_TWO = ("atan2", "copysign", "pow")
ARITHMETIC = {
    ast.Add: ("add", "fadd", operator.add),
    ast.Sub: ("sub", "fsub", operator.sub),
    ast.Mult: ("mul", "fmul", operator.mul),
    ast.Div: ("", "fdiv", operator.truediv),
}
COMPARISON = {
    ast.Eq: ("eq", "oeq"), ast.NotEq: ("ne", "une"), ast.Lt: ("slt", "olt"),
    ast.LtE: ("sle", "ole"), ast.Gt: ("sgt", "ogt"), ast.GtE: ("sge", "oge"),
}  # fmt: skip


@cache
def _functions_in(path: str) -> dict[str, ast.FunctionDef]:
    tree = ast.parse(Path(path).read_text("utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


def _bound_once(tree: ast.FunctionDef) -> tuple[set[str], set[str]]:
    """Return two sets of names in a function: all names that are read, and names set only once.

    A name counts as set only once if every statement that reads the name comes later.
    """
    set_at: dict[str, list[Any]] = {each.arg: [((0, -1),)] for each in tree.args.args}
    read_at: dict[str, list[Any]] = {}

    def visit(node: ast.AST, place: tuple[Any, ...]) -> None:
        for field, value in ast.iter_fields(node):
            if isinstance(value, list):
                blocks = value and isinstance(value[0], ast.stmt)
                for i, each in enumerate(value):
                    if isinstance(each, ast.AST):
                        visit(each, (*place, (id(value), i)) if blocks else place)
            elif isinstance(value, ast.AST):
                visit(value, place)
            if isinstance(node, ast.Name) and field == "id":
                stored = isinstance(node.ctx, ast.Store)
                (set_at if stored else read_at).setdefault(node.id, []).append(place)
        if isinstance(node, (ast.AugAssign, ast.For)):  # set again and again
            for each in ast.walk(node.target):
                if isinstance(each, ast.Name):
                    set_at.setdefault(each.id, []).append(place)
                    if isinstance(node, ast.AugAssign):
                        read_at.setdefault(each.id, []).append(place)

    for i, statement in enumerate(tree.body):
        visit(statement, ((0, i),))

    def after(read: tuple[Any, ...], first: tuple[Any, ...]) -> bool:
        depth = len(first) - 1
        return (
            len(read) > depth
            and read[:depth] == first[:depth]
            and read[depth][0] == first[depth][0]
            and read[depth][1] > first[depth][1]
        )

    once = {
        name
        for name, places in set_at.items()
        if len(places) == 1 and all(after(read, places[0]) for read in read_at.get(name, []))
    }
    return set(read_at), once


class Program:
    """LLVM program for a physics function ("law") and for all laws that it calls.

    A law is translated once for each combination of argument kinds with which it is called.
    """

    def __init__(self, inlined: set[Law]) -> None:
        self.inlined = inlined
        self.laws: dict[Any, tuple[str, Any]] = {}
        self.open: set[Any] = set()
        self.texts: list[str] = []
        self.constants: dict[tuple[float, ...], str] = {}
        self.declared: dict[str, str] = {}

    def translated(self, law: Law, kinds: tuple[Any, ...]) -> tuple[str, Any]:
        """Translate a law for given kinds of arguments.

        Return the symbol of the translated law, and the kind of the law's result.
        """
        if (law, kinds) in self.open:
            raise TypeError(f"{law.__name__} calls itself")
        if (law, kinds) not in self.laws:
            self.open.add((law, kinds))
            symbol = f'@"{law.__module__}.{law.__qualname__}.{len(self.laws)}"'
            known: dict[str, Any] = {}
            while True:
                body = _Body(self, law, kinds, known)
                if not body.widened:
                    break
            self.texts.append(body.text(symbol, law in self.inlined))
            self.laws[law, kinds] = symbol, body.known.get(RESULT, NOTHING)
            self.open.remove((law, kinds))
        return self.laws[law, kinds]

    def add_entry(self, symbol: str, law: Law, kinds: tuple[Any, ...], wanted: Any) -> None:
        """Add a function that calls a law, with arguments and result in memory.

        The function takes two addresses: the address of the law's arguments, and the address of the
        result, which is converted to the kind `wanted`.
        """
        given = Held(Row(None, kinds), "%given")
        entry = Instructions(self)
        _, result = entry.call_law(law, [entry.member(given, i) for i in range(len(kinds))])
        if wanted != NOTHING:
            entry.write(result, "%result", wanted)
        body = "\n".join([*entry.reserved, *entry.lines])
        self.texts.append(
            f'define void @"{symbol}"(ptr %given, ptr %result) nounwind {{\n{body}\nret void\n}}'
        )

    def declare(self, name: str, numbers: int) -> None:
        """Declare an external function of `numbers` real arguments that returns a real number."""
        self.declared[name] = f'declare double @"{name}"({", ".join(["double"] * numbers)})'

    def constant(self, values: tuple[float, ...]) -> str:
        """Add a constant table of numbers to the program if needed, and return its symbol."""
        return self.constants.setdefault(values, f"@table.{len(self.constants)}")

    def text(self) -> str:
        """Return the whole program as text in LLVM's language."""
        tables = [
            f"{symbol} = private constant [{len(values)} x double] "
            f"[{', '.join(f'double {number_of(value).text}' for value in values)}]"
            for values, symbol in self.constants.items()
        ]
        copy = "declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)"
        absolute = "declare double @llvm.fabs.f64(double)"
        return "\n".join([*tables, copy, absolute, *self.declared.values(), *self.texts])


class Uncompilable(TypeError):
    """Raised if a function uses Python that a law must not use."""


SHORT = 40
"""Number of instructions. A law with fewer instructions is inlined into its callers."""
RESULT = "return"


class _Body(Instructions):
    """Translation of the body of a law.

    `known` holds the kinds of the variables and of the result. `widened` is true if a later
    statement needs a wider kind, for example real instead of whole numbers. The law is then
    translated again.
    """

    def __init__(
        self, program: Program, law: Any, kinds: tuple[Any, ...], known: dict[str, Any]
    ) -> None:
        super().__init__(program)
        self.law, self.known, self.widened = law, known, False
        tree = _functions_in(law.__code__.co_filename)[law.__name__]
        self.read_names, self.once = _bound_once(tree)
        self.names: dict[str, Any] = {}
        self.slots: dict[str, str] = {}
        self.words: list[str] = []
        self.labels = 0
        self.loops: list[tuple[str, str]] = []
        for i, (argument, kind) in enumerate(zip(tree.args.args, kinds, strict=True)):
            self.take_argument(argument.arg, f"%a{i}", kind)
        try:
            if self.run(tree.body):
                if self.known.get(RESULT, NOTHING) != NOTHING:
                    raise TypeError("the end of the law is reached without a result")
                self.emit("ret void")
        except Uncompilable:
            raise
        except (TypeError, KeyError, AttributeError, ValueError) as failure:
            where = f"{law.__module__}.{law.__name__}, line {self.line}"
            raise Uncompilable(f"{where} cannot be compiled: {failure!r}") from failure

    def take_argument(self, name: str, word: str, kind: Any) -> None:
        if isinstance(kind, Global):
            self.names[name] = kind
            return
        if isinstance(kind, Row):
            self.words.append(f"ptr {word}")
            value: Any = Held(kind, word)
        elif isinstance(kind, Array):
            shape = [f"{word}.{k}" for k in range(kind.dimensions)]
            self.words += [f"ptr {word}", *(f"i64 {length}" for length in shape)]
            value = ArrayView(kind, word, tuple(shape))
        else:
            self.words.append(f"{kind} {word}")
            value = Number(kind, word)
        self.bind(name, value)

    def text(self, symbol: str, inlined: bool) -> str:
        result, words = self.known.get(RESULT, NOTHING), self.words
        if not isinstance(result, str):
            words, result = ["ptr %result", *words], "void"
        how = "alwaysinline nounwind" if inlined or len(self.lines) < SHORT else "nounwind"
        lines: list[str] = []
        for line in self.lines:
            lines += line if isinstance(line, list) else [line]
        body = "\n".join([*self.reserved, *lines])
        return f"define internal {result} {symbol}({', '.join(words)}) {how} {{\n{body}\n}}"

    def _label(self) -> str:
        self.labels += 1
        return f"l{self.labels}"

    def _start(self, label: str) -> None:
        self.emit(f"{label}:")

    def _jump(self, label: str) -> None:
        self.emit(f"br label %{label}")

    def _branch(self, test: Number, yes: str, no: str) -> None:
        self.emit(f"br i1 {test.text}, label %{yes}, label %{no}")

    def widen(self, name: str, kind: Any) -> Any:
        """Return the kind of a variable after another value has been assigned."""
        known = self.known.get(name)
        if known is None:
            self.known[name] = kind
        elif known != kind:
            wider = common(known, kind)
            self.widened |= wider != known
            self.known[name] = wider
        return self.known[name]

    def bind(self, name: str, value: Any) -> None:
        if name not in self.read_names:
            return
        if name in self.once:
            self.names[name] = self.kept(value)
            return
        value, kind = self.kept(value), self.widen(name, value.kind)
        if name not in self.slots:
            self.slots[name] = self.reserve(kind)
        self.write(value, self.slots[name], kind)

    # statements; each returns whether the next statement can be reached

    def run(self, statements: list[Any]) -> bool:
        for statement in statements:
            self.line = statement.lineno
            if not getattr(self, f"_do_{type(statement).__name__.lower()}")(statement):
                return False
        return True

    def _do_expr(self, node: Any) -> bool:
        if isinstance(node.value, ast.Call):
            self.of(node.value)
        return True

    def _do_assert(self, node: Any) -> bool:
        return True

    def _do_pass(self, node: Any) -> bool:
        return True

    def _do_assign(self, node: Any) -> bool:
        value = self.of(node.value)
        if isinstance(node.targets[0], ast.Tuple):
            value = self.kept(value)
        for target in node.targets:
            self.put(target, value)
        return True

    def _do_annassign(self, node: Any) -> bool:
        self.put(node.target, self.of(node.value))
        return True

    def _do_augassign(self, node: Any) -> bool:
        read = ast.copy_location(_reading(node.target), node)
        value = self.of(ast.BinOp(read, node.op, node.value))
        self.put(node.target, value)
        return True

    def put(self, target: Any, value: Any) -> None:
        if isinstance(target, ast.Name):
            self.bind(target.id, value)
        elif isinstance(target, ast.Tuple):
            for i, each in enumerate(target.elts):
                self.put(each, self.member(value, i))
        else:
            array, address = self.element(target)
            self.write(value, address, array.item)

    def _do_return(self, node: Any) -> bool:
        if node.value is None:
            self.emit("ret void")
            return False
        value = self.of(node.value)
        kind = self.widen(RESULT, value.kind)
        if isinstance(kind, str):
            self.emit(f"ret {kind} {self.as_kind(value, kind).text}")
        else:
            self.write(value, "%result", kind)
            self.emit("ret void")
        return False

    def _do_if(self, node: Any) -> bool:
        yes, no, end = self._label(), self._label(), self._label()
        self._branch(self.test(node.test), yes, no if node.orelse else end)
        self._start(yes)
        reached = self.run(node.body)
        if reached:
            self._jump(end)
        if node.orelse:
            self._start(no)
            otherwise = self.run(node.orelse)
            if otherwise:
                self._jump(end)
            reached |= otherwise
        else:
            reached = True
        if reached:
            self._start(end)
        return reached

    def _do_while(self, node: Any) -> bool:
        again, body, over, end = self._label(), self._label(), self._label(), self._label()
        self._jump(again)
        self._start(again)
        forever = isinstance(node.test, ast.Constant)
        if forever:
            self._jump(body)
        else:
            self._branch(self.test(node.test), body, over)
        self._start(body)
        if self.loop(node.body, again, end):
            self._jump(again)
        return self.finish(node, not forever, over, end)

    def loop(self, body: list[Any], again: str, end: str) -> bool:
        self.loops.append((again, end))
        reached = self.run(body)
        self.loops.pop()
        return reached

    def finish(self, node: Any, ends: bool, over: str, end: str) -> bool:
        """Translate the `else` part of a loop, and begin the code after the loop.

        Return whether the statement after the loop can be reached.

        Parameters
        ----------
        ends : whether the loop can end without `break`
        over : label of the `else` part
        end : label of the code after the loop
        """
        if ends:
            self._start(over)
            ends = self.run(node.orelse)
            if ends:
                self._jump(end)
        left = ends or any(isinstance(each, ast.Break) for each in ast.walk(node))
        if left:
            self._start(end)
        return left

    def _do_for(self, node: Any) -> bool:
        over, end = self._label(), self._label()
        if isinstance(node.iter, ast.Tuple):
            for value in [self.kept(self.of(each)) for each in node.iter.elts]:
                following = self._label()
                self.put(node.target, value)
                if self.loop(node.body, following, end):
                    self._jump(following)
                self._start(following)
            self._jump(over)
            return self.finish(node, True, over, end)
        given = [self.as_kind(self.of(each), WHOLE) for each in node.iter.args]
        first, last, step = number_of(0), given[-1], number_of(1)
        if len(given) > 1:
            first, last = given[:2]
        if len(given) > 2:
            step = given[2]
        test, body, following = self._label(), self._label(), self._label()
        counter = self.reserve(WHOLE)
        self.emit(f"store i64 {first.text}, ptr {counter}")
        self._jump(test)
        self._start(test)
        here = self.value(WHOLE, f"load i64, ptr {counter}")
        order = "slt" if step.known > 0 else "sgt"
        self._branch(self.value(TRUTH, f"icmp {order} i64 {here.text}, {last.text}"), body, over)
        self._start(body)
        self.put(node.target, here)
        if self.loop(node.body, following, end):
            self._jump(following)
        self._start(following)
        after = self.value(WHOLE, f"add nsw i64 {here.text}, {step.text}")
        self.emit(f"store i64 {after.text}, ptr {counter}")
        self._jump(test)
        return self.finish(node, True, over, end)

    def _do_break(self, node: Any) -> bool:
        self._jump(self.loops[-1][1])
        return False

    def _do_continue(self, node: Any) -> bool:
        self._jump(self.loops[-1][0])
        return False

    # expressions

    def refuse(self, part: Any) -> None:
        if part:
            what = part[0] if isinstance(part, list) else part
            raise TypeError(f"`{ast.unparse(what)}` is not allowed here in a law")

    def of(self, node: Any) -> Any:
        """Translate an expression."""
        return getattr(self, f"_of_{type(node).__name__.lower()}")(node)

    def number(self, node: Any) -> Number:
        value = self.of(node)
        if not isinstance(value, Number):
            raise TypeError(f"{ast.unparse(node)} is not a number")
        return value

    def test(self, node: Any) -> Number:
        if isinstance(node, ast.BoolOp):
            found: Number = self.either(node, self.test)
            return found
        return self.truth(self.number(node))

    def truth(self, value: Number) -> Number:
        """Return whether a number is not zero."""
        if value.kind == TRUTH:
            return value
        if value.known is not None:
            return number_of(bool(value.known))
        zero = "icmp ne i64 {}, 0" if value.kind == WHOLE else "fcmp une double {}, 0.0"
        return self.value(TRUTH, zero.format(value.text))

    def _of_constant(self, node: Any) -> Any:
        return row_of(()) if node.value is None else number_of(node.value)

    def _of_name(self, node: Any) -> Any:
        if node.id in self.names:
            return self.names[node.id]
        if node.id in self.slots:
            return self.read(self.known[node.id], self.slots[node.id], True)
        found = self.law.__globals__.get(node.id, getattr(builtins, node.id, self))
        if found is self or node.id in self.law.__code__.co_varnames:
            raise TypeError(f"{node.id} has no value")
        return self.given(found)

    def given(self, value: Any) -> Any:
        """Convert a global number, tuple, function, class or module for use in a law."""
        if isinstance(value, (bool, int, float)):
            return number_of(value)
        if isinstance(value, tuple):
            if type(value) is tuple and all(isinstance(each, float) for each in value):
                table = self.program.constant(value)
                return ArrayView(Array(REAL, 1), table, (str(len(value)),))
            named = type(value) if hasattr(value, "_fields") else None
            wanted = wanted_by(named) if named else [None] * len(value)
            members = [self.given(each) for each in value]
            pairs = zip(members, wanted, strict=True)
            return row_of([self.as_kind(a, b) if b else a for a, b in pairs], named)
        return Global(value)

    def _of_attribute(self, node: Any) -> Any:
        owner = self.of(node.value)
        if isinstance(owner, Global):
            if not isinstance(owner.value, ModuleType):
                raise TypeError(f"{ast.unparse(node)} has no value in a law")
            return self.given(getattr(owner.value, node.attr))
        if isinstance(owner.kind, Array):
            shape = self.viewed(owner).shape
            if node.attr == "shape":
                return row_of(Number(WHOLE, length) for length in shape)
            if node.attr != "size" or len(shape) != 1:
                raise TypeError(f"a sequence has no {node.attr}")
            return Number(WHOLE, shape[0])
        return self.member(owner, owner.kind.named._fields.index(node.attr))

    def _of_subscript(self, node: Any) -> Any:
        owner = self.of(node.value)
        if isinstance(owner.kind, Row):
            return self.member(owner, self.number(node.slice).known)
        if isinstance(node.slice, ast.Slice):
            return self.part_of(self.viewed(owner), node.slice)
        array, address = self.element(node, owner)
        if array.dimensions == 0:
            return self.read(array.item, address, passing=True)
        view = self.viewed(owner)
        shape = view.shape[len(view.shape) - array.dimensions :]
        return ArrayView(array, address, shape)

    def element(self, node: Any, owner: Any = None) -> tuple[Array, str]:
        """Return the kind and the address of the part of a sequence that the indices select."""
        view = self.viewed(owner or self.of(node.value))
        indices = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        unit, address = size_of(view.kind.item), view.data
        for k, each in enumerate(indices):
            index = self.as_kind(self.number(each), WHOLE)
            place = index.text
            if index.known is not None and index.known < 0:
                place = self.value(WHOLE, f"add nsw i64 {view.shape[k]}, {place}").text
            for length in view.shape[k + 1 :]:
                if place != "0":
                    place = self.value(WHOLE, f"mul nsw i64 {place}, {length}").text
            address = self.at(address, place, unit)
        left = view.kind.dimensions - len(indices)
        return Array(view.kind.item, left), address

    def part_of(self, view: ArrayView, bounds: Any) -> ArrayView:
        """Return a slice of a one-dimensional sequence. The bounds must not be negative."""
        self.refuse(bounds.step)
        if view.kind.dimensions != 1:
            raise TypeError("only a sequence of one dimension can be sliced")
        first, last = number_of(0), Number(WHOLE, view.shape[0])
        if bounds.upper is not None:
            last = self.lesser(self.bound(bounds.upper), last, "slt")
        if bounds.lower is not None:
            first = self.bound(bounds.lower)
        data = self.at(view.data, first.text, size_of(view.kind.item))
        length = self.value(WHOLE, f"sub nsw i64 {last.text}, {first.text}")
        return ArrayView(view.kind, data, (self.lesser(length, number_of(0), "sgt").text,))

    def bound(self, node: Any) -> Number:
        bound: Number = self.as_kind(self.number(node), WHOLE)
        if bound.known is not None and bound.known < 0:
            raise TypeError("the bounds of a slice must not be negative")
        return bound

    def _of_tuple(self, node: Any) -> Made:
        return row_of(self.of(each) for each in node.elts)

    def _of_unaryop(self, node: Any) -> Number:
        if isinstance(node.op, ast.Not):
            value = self.test(node.operand)
            return self.value(TRUTH, f"xor i1 {value.text}, true")
        value = self.number(node.operand)
        if not isinstance(node.op, ast.USub):
            raise TypeError(f"{ast.unparse(node)} has an operator that laws do not use")
        if value.known is not None:
            return number_of(-value.known)
        if value.kind == REAL:
            return self.value(REAL, f"fneg double {value.text}")
        return self.value(WHOLE, f"sub nsw i64 0, {self.as_kind(value, WHOLE).text}")

    def _of_binop(self, node: Any) -> Number:
        left, right = self.number(node.left), self.number(node.right)
        if isinstance(node.op, ast.BitOr) and left.kind == right.kind == TRUTH:
            return self.value(TRUTH, f"or i1 {left.text}, {right.text}")
        if isinstance(node.op, ast.FloorDiv) and left.kind == right.kind == WHOLE:
            if right.known is None or right.known < 1 or right.known & (right.known - 1):
                raise TypeError("in a law, the divisor of // must be a power of two")
            shift = right.known.bit_length() - 1
            return self.value(WHOLE, f"ashr i64 {left.text}, {shift}")
        whole, real, known = ARITHMETIC[type(node.op)]
        if left.known is not None and right.known is not None:
            return number_of(known(left.known, right.known))
        kind = common(common(left.kind, right.kind), WHOLE if whole else REAL)
        left, right = self.as_kind(left, kind), self.as_kind(right, kind)
        how = real if kind == REAL else f"{whole} nsw"
        return self.value(kind, f"{how} {kind} {left.text}, {right.text}")

    def _of_boolop(self, node: Any) -> Any:
        return self.either(node, self.number)

    def either(self, node: Any, of: Callable[[Any], Number]) -> Any:
        """Translate `and` or `or`. The result is the last operand that Python evaluates."""
        stop, end = isinstance(node.op, ast.Or), self._label()
        values: list[Any] = []
        later: list[list[str]] = []
        for i, each in enumerate(node.values):
            values.append(of(each))
            later.append(self.gap())
            following = end if i == len(node.values) - 1 else self._label()
            if following == end:
                self._jump(end)
            elif stop:
                self._branch(self.truth(values[-1]), end, following)
            else:
                self._branch(self.truth(values[-1]), following, end)
            self._start(following)
        return self.one_of(values, later)

    def gap(self) -> list[str]:
        """Return a place for instructions that are added later."""
        self.lines.append([])
        gap: list[str] = self.lines[-1]
        return gap

    def one_of(self, values: list[Any], later: list[list[str]]) -> Any:
        """Return the value of the branch that is executed at run time.

        Parameters
        ----------
        values : the value of each branch
        later : for each branch, the place (`gap`) for the instructions that store its value
        """
        kind = values[0].kind
        for each in values:
            kind = common(kind, each.kind)
        slot, lines = self.reserve(kind), self.lines
        for value, own in zip(values, later, strict=True):
            self.lines = own
            self.write(value, slot, kind)
        self.lines = lines
        return self.read(kind, slot)

    def _of_compare(self, node: Any) -> Number:
        left, found = self.number(node.left), None
        for op, each in zip(node.ops, node.comparators, strict=True):
            if isinstance(op, ast.In):
                tests = [self.compared(ast.Eq, left, self.number(one)) for one in each.elts]
                test = self.joined("or", tests)
            else:
                right = self.number(each)
                test = self.compared(type(op), left, right)
                left = right
            found = test if found is None else self.joined("and", [found, test])
        assert found is not None
        return found

    def joined(self, how: str, tests: list[Number]) -> Number:
        found, *others = tests
        for each in others:
            found = self.value(TRUTH, f"{how} i1 {found.text}, {each.text}")
        return found

    def compared(self, op: Any, left: Number, right: Number) -> Number:
        kind = common(common(left.kind, right.kind), WHOLE)
        left, right = self.as_kind(left, kind), self.as_kind(right, kind)
        whole, real = COMPARISON[op]
        how = f"fcmp {real}" if kind == REAL else f"icmp {whole}"
        return self.value(TRUTH, f"{how} {kind} {left.text}, {right.text}")

    def _of_ifexp(self, node: Any) -> Any:
        yes, no, end = self._label(), self._label(), self._label()
        self._branch(self.test(node.test), yes, no)
        values: list[Any] = []
        later: list[list[str]] = []
        for label, branch in ((yes, node.body), (no, node.orelse)):
            self._start(label)
            values.append(self.of(branch))
            later.append(self.gap())
            self._jump(end)
        self._start(end)
        return self.one_of(values, later)

    def _of_call(self, node: Any) -> Any:
        self.refuse(node.keywords and node.keywords[0].value)
        called = self.of(node.func)
        given = [self.of(each) for each in node.args]
        function = called.value
        if isinstance(function, FunctionType):
            if function.__name__ == "set_row":
                array = self.viewed(given[0])
                address = self.at(array.data, given[1].text, size_of(array.kind.item))
                self.write(given[2], address, array.kind.item)
                return row_of(())
            return self.call_law(function, given)[1]
        if hasattr(function, "_fields"):
            pairs = zip(given, wanted_by(function), strict=True)
            return row_of([self.as_kind(a, b) if b else a for a, b in pairs], function)
        called_so = getattr(self, f"_call_{function.__name__}", self._call_math)
        return called_so(function, *given)

    def _call_math(self, function: Any, *given: Any) -> Number:
        name = function.__name__
        symbol = INTRINSIC.get(name, f"calm.{name}")
        if function is not getattr(math, name, None) or name not in (*INTRINSIC, *FROM_MATH):
            raise TypeError(f"the function {name} cannot be used in a law")
        if len(given) != (2 if name in OF_TWO else 1):
            raise TypeError(f"{name} has {len(given)} arguments")
        self.program.declare(symbol, len(given))
        numbers = [f"double {self.as_kind(each, REAL).text}" for each in given]
        return self.value(REAL, f'call double @"{symbol}"({", ".join(numbers)})')

    def _call_len(self, _: Any, array: Any) -> Number:
        if isinstance(array.kind, Row):
            return number_of(len(array.kind.members))
        return Number(WHOLE, self.viewed(array).shape[0])

    def _call_abs(self, _: Any, value: Number) -> Number:
        if value.kind == REAL:
            return self.value(REAL, f"call double @llvm.fabs.f64(double {value.text})")
        value = self.as_kind(value, WHOLE)
        return self.lesser(self.value(WHOLE, f"sub nsw i64 0, {value.text}"), value, "sgt")

    def lesser(self, one: Number, other: Number, order: str) -> Number:
        """Return the whole number that comes first in LLVM's order `slt` or `sgt`."""
        test = self.value(TRUTH, f"icmp {order} i64 {one.text}, {other.text}")
        return self.value(WHOLE, f"select i1 {test.text}, i64 {one.text}, i64 {other.text}")

    def _call_max(self, function: Any, *given: Any) -> Number:
        """Translate `max` or `min`; equal numbers and NaN are treated as by CPython."""
        kind = given[0].kind
        for each in given:
            kind = common(kind, each.kind)
        numbers: list[Number] = [self.as_kind(each, kind) for each in given]
        best, *others = numbers
        op = ast.Gt if function is max else ast.Lt
        for each in others:
            test = self.compared(op, each, best)
            best = self.value(
                kind, f"select i1 {test.text}, {kind} {each.text}, {kind} {best.text}"
            )
        return best

    _call_min = _call_max

    def _call_floor(self, function: Any, value: Number) -> Number:
        return self._call_int(function, self._call_math(function, value))

    def _call_int(self, _: Any, value: Number) -> Number:
        if value.kind == REAL:
            return self.value(WHOLE, f"fptosi double {value.text} to i64")
        found: Number = self.as_kind(value, WHOLE)
        return found

    def _call_float(self, _: Any, value: Number) -> Number:
        found: Number = self.as_kind(value, REAL)
        return found

    def _call_bool(self, _: Any, value: Number) -> Number:
        return self.truth(value)

    def _call_isnan(self, _: Any, value: Number) -> Number:
        value = self.as_kind(value, REAL)
        return self.value(TRUTH, f"fcmp uno double {value.text}, {value.text}")

    def _call_isfinite(self, function: Any, value: Number) -> Number:
        size = self._call_abs(function, self.as_kind(value, REAL))
        return self.value(TRUTH, f"fcmp olt double {size.text}, {number_of(math.inf).text}")

    def _call_degrees(self, _: Any, value: Number) -> Number:
        value = self.as_kind(value, REAL)
        return self.value(REAL, f"fmul double {value.text}, {number_of(180.0 / math.pi).text}")


def _reading(target: Any) -> Any:
    """Return the expression that reads a variable or an element."""
    if isinstance(target, ast.Name):
        return ast.Name(target.id, ast.Load())
    return ast.Subscript(target.value, target.slice, ast.Load())
