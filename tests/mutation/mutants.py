"""The small changes of a source file that its tests should notice, one at a time, at exact places."""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

# What stands in for what. The other way round, too.
SWAPS = {"+": "-", "*": "/", "<": "<=", ">": ">=", "and": "or"}
SWAPPED = {**SWAPS, **{new: old for old, new in SWAPS.items()}}
COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}
ARITHMETIC = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
# Calls whose numbers are bounds.
BOUNDING = {"min", "max", "minimum", "maximum", "clip", "range"}
# By this factor a bound that is no whole number is raised; a bound of 0 becomes this much less than 1.
RAISED = 1.25


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class Mutant:
    """One change.

    Attributes:
        path: of the file, from the root of the checkout, with forward slashes.
        line: number of the line, from 1.
        column: of the change in its line, from 0.
        old: what stands there.
        new: what is put instead.
        function: first and last line of the outermost function about it; (0, 0) outside any.
    """

    path: str
    line: int
    column: int
    old: str
    new: str
    function: tuple[int, int]

    def lines(self, text: str) -> tuple[str, str]:
        """The line as it is and as it becomes, without the space about it."""
        line = text.splitlines()[self.line - 1]
        changed = line[: self.column] + self.new + line[self.column + len(self.old) :]
        return line.strip(), changed.strip()

    def applied(self, text: str) -> str:
        """The file's text with the change."""
        lines = text.splitlines(keepends=True)
        line = lines[self.line - 1]
        assert line[self.column :].startswith(self.old), f"{self.path}:{self.line} is not what it was"
        lines[self.line - 1] = line[: self.column] + self.new + line[self.column + len(self.old) :]
        return "".join(lines)


def mutants_of(path: str, text: str) -> list[Mutant]:
    """All changes of a file, in the order of their places."""
    tree = ast.parse(text)
    spans = [_span(node) for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    statements = [_span(one) for one in tree.body]
    lines = text.splitlines()
    found = set()
    for line, column, old, new in _changes(tree, text):
        column = len(lines[line - 1].encode()[:column].decode())  # the parser counts bytes
        function = min((span for span in spans if span[0] <= line <= span[1]), default=(0, 0))
        mutant = Mutant(path=path, line=line, column=column, old=old, new=new, function=function)
        if _compiles(mutant, text, statements):
            found.add(mutant)
    return sorted(found)


def _span(node: ast.stmt) -> tuple[int, int]:
    """First and last line of a statement with its decorators."""
    decorators: list[ast.expr] = getattr(node, "decorator_list", [])
    return min([node.lineno, *(one.lineno for one in decorators)]), node.end_lineno or 0


def _compiles(mutant: Mutant, text: str, statements: Sequence[tuple[int, int]]) -> bool:
    """Whether the statement at the file's top level in which a change is made is still one."""
    first, last = next(span for span in statements if span[0] <= mutant.line <= span[1])
    lines = mutant.applied(text).splitlines(keepends=True)
    try:
        ast.parse("".join(lines[first - 1 : last]))
    except SyntaxError:
        return False
    return True


Change = tuple[int, int, str, str]


def _changes(tree: ast.Module, text: str) -> Iterator[Change]:
    """Line, column in bytes, old and new text of each change."""
    source = _Source(text)
    for node in _arithmetic(tree):
        if isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC and not _is_text(node):
            yield from source.swap(node.left, node.right, ARITHMETIC[type(node.op)])
        elif isinstance(node, ast.AugAssign) and type(node.op) in ARITHMETIC:
            yield from source.swap(node.target, node.value, ARITHMETIC[type(node.op)], ending="=")
        elif isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            for op, left, right in zip(node.ops, sides, sides[1:], strict=False):
                if type(op) in COMPARISONS:
                    yield from source.swap(left, right, COMPARISONS[type(op)])
            yield from source.raised(sides)
        elif isinstance(node, ast.BoolOp):
            word = "and" if isinstance(node.op, ast.And) else "or"
            for left, right in zip(node.values, node.values[1:], strict=False):
                yield from source.swap(left, right, word)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            yield node.lineno, node.col_offset, "-", ""
        elif isinstance(node, ast.Call) and _name(node.func) in BOUNDING:
            yield from source.raised(node.args)


def _raised(number: float) -> float:
    """A whole number raised by one, any other by a quarter."""
    return number + 1 if isinstance(number, int) else RAISED * number or RAISED - 1.0


def _name(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")


def _is_text(node: ast.expr) -> bool:
    """Whether texts are put together, not numbers."""
    if isinstance(node, ast.BinOp):
        return _is_text(node.left) or _is_text(node.right)
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str | bytes))


def _arithmetic(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes but types, and which axis of an array is meant: counted from its end it is mostly the same one."""
    yield node
    for field, value in ast.iter_fields(node):
        if field not in ("annotation", "returns"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not (isinstance(child, ast.keyword) and child.arg == "axis"):
                    yield from _arithmetic(child)


class _Source:
    """A file's lines and tokens, among which operators are found by what stands before and behind them."""

    def __init__(self, text: str) -> None:
        self._lines = [line.encode() for line in text.splitlines()]
        self._tokens = [
            (token.start[0], len(token.line[: token.start[1]].encode()), token.string)
            for token in tokenize.generate_tokens(io.StringIO(text).readline)
            if token.type in (tokenize.OP, tokenize.NAME)
        ]

    def swap(self, left: ast.expr, right: ast.expr, operator: str, ending: str = "") -> Iterator[Change]:
        """The operator between two operands, which may have an ending (of +=), as another one."""
        after, before = (left.end_lineno or 0, left.end_col_offset or 0), (right.lineno, right.col_offset)
        for line, column, token in self._tokens:
            if after <= (line, column) < before and token == operator + ending:
                yield line, column, operator, SWAPPED[operator]
                return

    def raised(self, sides: Sequence[ast.expr]) -> Iterator[Change]:
        """Those of some numbers that are written out, raised."""
        for node in sides:
            if isinstance(node, ast.Constant) and isinstance(node.value, int | float) and type(node.value) is not bool:
                text = self._lines[node.lineno - 1][node.col_offset : node.end_col_offset].decode()
                yield node.lineno, node.col_offset, text, repr(_raised(node.value))
