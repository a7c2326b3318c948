"""Read variables from a `.mat` file written by any version of MATLAB or Octave.

Binary, HDF5 and Octave text files are supported, also compressed. No content is executed or
unpickled.
"""

from __future__ import annotations

import io
import math
import zlib
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from calm.errors import refused
from calm.exchange.foreign_process import read_apart
from calm.whole_file import read_content

LARGEST = 200_000_000
"""Maximum size of a file, also after decompression [bytes]."""

_GZIP = b"\x1f\x8b"
_OCTAVE_BINARY = b"Octave-1-"
_HEAD = 70_000  # bytes by which a compressed file is recognised
_CELL = "<cell-element>"
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_TEXTS = ("char", "string", "sq_string")
_DEEPEST = 4  # cells in cells
MatValue: TypeAlias = "NDArray[Any] | str | list[MatValue]"
"""Value of a variable: numbers or characters, a text, or the elements of a cell array."""

_MOST = 20_000_000
"""Maximum number of elements in a variable."""

RealArray = NDArray[np.float64]


def read_variables(path: Path, wanted: Collection[str]) -> MatVariables:
    """Read the variables of a file whose names are in `wanted`; missing variables are omitted.

    Raises
    ------
    InputError
        The file is not a `.mat` file, or is damaged.
    """
    content = _inflated(read_content(path, largest=LARGEST), LARGEST + 1)
    if len(content) > LARGEST:
        raise refused(path, f"holds more than {LARGEST // 1_000_000} MB once it is decompressed")
    if content.startswith(_OCTAVE_BINARY):
        raise refused(
            path, "is in Octave's binary format; save it in Octave with -v7, -hdf5 or -text"
        )
    try:
        return MatVariables(read_apart(_variables, content, list(wanted)))
    except ValueError as error:
        raise refused(path, f"is damaged, or is not a MATLAB or Octave file ({error})") from None


def _variables(content: bytes, wanted: Collection[str]) -> dict[str, MatValue]:
    if _is_octave_text(content):
        found = read_octave_text(content.decode("utf-8", "replace"))
    elif _is_hdf5(content):
        found = _read_hdf5(content, wanted)
    else:
        found = _matlab(content, wanted)
    return {name: value for name, value in found.items() if name in wanted}


def is_mat(content: bytes) -> bool:
    """True if a file begins like a MATLAB or Octave file."""
    content = _inflated(content, _HEAD)
    if _is_octave_text(content) or content.startswith((b"MATLAB 5.0", _OCTAVE_BINARY)):
        return True
    return _is_hdf5(content) or _is_version_4(content)


def _inflated(content: bytes, most: int) -> bytes:
    if not content.startswith(_GZIP):
        return content
    try:
        # unlike `gzip`, a decompressor also accepts the head of a file
        return zlib.decompressobj(wbits=31).decompress(content, most)
    except zlib.error:
        return content


def _is_version_4(content: bytes) -> bool:
    # the header: type, rows, columns, whether complex, and length of the name
    for order in ("<", ">"):
        head = np.frombuffer(content[:20], f"{order}i4") if len(content) > 20 else np.zeros(0)
        if head.size == 5 and 0 <= head[0] < 5000 and 1 < head[4] < 64 and head[3] in (0, 1):
            name = content[20 : 20 + int(head[4])]
            return name.endswith(b"\0") and name[:-1].replace(b"_", b"a").isalnum()
    return False


def _matlab(content: bytes, wanted: Collection[str]) -> dict[str, MatValue]:
    from scipy.io import loadmat, whosmat

    names = [name for name, shape, _ in whosmat(io.BytesIO(content)) if _fits(name, shape)]
    chosen = [name for name in names if name in wanted]
    found = loadmat(io.BytesIO(content), variable_names=chosen, struct_as_record=True)
    return {name: found[name] for name in chosen if name in found}


def _is_octave_text(content: bytes) -> bool:
    start = content[:4096]
    return b"\0" not in start and start.lstrip().startswith(b"#") and b"# name:" in content[:65536]


def read_octave_text(text: str) -> dict[str, MatValue]:
    """Read the variables of an Octave text file; variables that cannot be read are omitted.

    Raises
    ------
    ValueError
        A matrix has fewer numbers than its header states, or a header cannot be read.
    """
    variables: dict[str, MatValue] = {}
    cell: list[MatValue] | None = None
    for name, header, rows in _blocks(text.splitlines()):
        kind = header.get("type", "").removeprefix("global ").strip()
        value = _value(name, kind, header, rows)
        if name == _CELL:
            if cell is not None and value is not None:
                cell.append(value)
        elif kind == "cell":
            cell = variables[name] = []
        else:
            cell = None
            if value is not None:
                variables[name] = value
    return variables


def _blocks(lines: list[str]) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    name, header, rows = "", dict[str, str](), list[str]()
    for line in lines:
        key, value = _header(line)
        if key == "name":
            if name:
                yield name, header, rows
            name, header, rows = value, {}, []
        elif key and key not in ("length", "base, limit, increment"):
            header.setdefault(key, value)
        elif name:
            rows.append(line)
    if name:
        yield name, header, rows


def _header(line: str) -> tuple[str, str]:
    """Parse a header line such as ``# rows: 3``, with or without colon, to key and value."""
    if not line.lstrip().startswith("#"):
        return "", ""
    body = line.lstrip()[1:].strip()
    key, colon, value = body.partition(":")
    if not colon:
        key, _, value = body.partition(" ")
    return key.strip().lower(), value.strip()


def _value(name: str, kind: str, header: dict[str, str], rows: list[str]) -> MatValue | None:
    if kind in ("string", "sq_string"):
        return _texts(rows)
    if kind == "cell" or not kind:
        return None
    bare = [row for row in rows if row.strip() and not row.lstrip().startswith("#")]
    try:
        words = (word for row in bare for word in row.replace(",", " ").split())
        numbers = np.array([float(word) for word in words])
    except ValueError:
        return None  # a structure or complex numbers, which no importer needs
    if kind.endswith("range") and len(numbers) == 3:
        return _range_numbers(name, *numbers.tolist())
    if "scalar" in kind or kind == "bool":
        return numbers[:1].reshape(1, -1)
    if "ndims" in header:
        dims = int(float(header["ndims"]))
        return _shaped(name, numbers[dims:], [int(size) for size in numbers[:dims]], order="F")
    given = (header.get(key, "") for key in ("rows", "columns"))
    stated = [int(text) if text.isdigit() else 0 for text in given]
    if math.prod(stated) != numbers.size and bare and numbers.size % len(bare) == 0:
        return numbers.reshape(len(bare), -1)  # the header was edited: each line is a row
    return _shaped(name, numbers, stated, order="C")


def _range_numbers(name: str, first: float, last: float, step: float) -> MatValue:
    # the limit belongs to the range if a step ends there, despite rounding
    count = (last - first) / step * (1 + 1e-12) + 1 if step else 0.0
    if not 0.0 <= count <= _MOST:
        raise ValueError(f"the range `{name}` has {count:g} numbers, too many to read")
    return first + step * np.arange(int(count))


def _shaped(name: str, array: RealArray, shape: list[int], *, order: str) -> MatValue:
    if int(np.prod(shape)) != array.size:
        size = "×".join(str(length) for length in shape)
        raise ValueError(f"`{name}` should have {size} numbers but has {array.size}")
    return array.reshape(shape, order="F" if order == "F" else "C")


def _texts(rows: list[str]) -> list[MatValue]:
    """Read the rows of a character matrix; each row follows a line with its length."""
    texts: list[MatValue] = []
    for i, row in enumerate(rows):
        if _header(row)[0] == "length":
            behind = rows[i + 1] if i + 1 < len(rows) else ""
            texts.append("" if _header(behind)[0] == "length" else behind.rstrip())
    return texts


def _is_hdf5(content: bytes) -> bool:
    return _SIGNATURE in (content[:8], content[512:520])  # MATLAB has a header of 512 bytes


def _read_hdf5(content: bytes, wanted: Collection[str]) -> dict[str, MatValue]:
    import h5py

    with h5py.File(io.BytesIO(content), "r") as file:
        links = {name: file.get(name, getlink=True) for name in wanted}
        # links to other files are not followed
        hard = [name for name, link in links.items() if isinstance(link, h5py.HardLink)]
        return {name: _variable(file, file[name], 0) for name in hard}


def _variable(file: Any, node: Any, depth: int) -> MatValue:
    """Read a variable, which MATLAB stores as an HDF5 dataset and Octave as a group.

    `depth` is the number of cell arrays around the variable.
    """
    import h5py

    if depth > _DEEPEST:
        raise ValueError("cells are nested too deeply")
    if not isinstance(node, h5py.Group):
        return _values(file, node, _text_of(node.attrs.get("MATLAB_class", "")), depth)
    hard = [isinstance(node.get(key, getlink=True), h5py.HardLink) for key in ("type", "value")]
    if not all(hard) or not isinstance(node["type"], h5py.Dataset):
        return np.zeros((0, 0))  # a structure
    kind, value = _text_of(node["type"][()]), node["value"]
    if not isinstance(value, h5py.Group):
        return _values(file, value, kind.removeprefix("global ").strip(), depth)
    elements = [key for key in value if key.startswith("_") and key[1:].isdigit()]
    return [
        _variable(file, value[key], depth + 1)
        for key in sorted(elements, key=lambda key: int(key[1:]))
    ]


def _values(file: Any, node: Any, kind: str, depth: int) -> MatValue:
    import h5py

    if not isinstance(node, h5py.Dataset) or node.is_virtual or node.external:
        raise ValueError("a variable refers to another file")
    if node.attrs.get("MATLAB_empty", 0) or node.attrs.get("OCTAVE_EMPTY_MATRIX", 0):
        return np.zeros((0, 0))
    _fits(node.name, node.shape)
    value = node[()]
    if node.dtype == h5py.ref_dtype:
        return [_variable(file, file[each], depth + 1) for each in np.asarray(value).ravel()]
    if node.dtype.names == ("base", "limit", "increment"):
        return _range_numbers(node.name, *(float(value[name]) for name in node.dtype.names))
    array = np.asarray(value).T  # HDF5 stores the dimensions in reverse order
    if kind in _TEXTS:
        rows = np.atleast_2d(array)
        if array.dtype.kind == "i":
            return [
                row.astype(np.uint8).tobytes().decode("utf-8", "replace").rstrip() for row in rows
            ]
        return ["".join(chr(int(code)) for code in row).rstrip() for row in rows]
    return array


def _text_of(value: object) -> str:
    return value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)


class MatVariables(dict[str, MatValue]):
    """Variables of a `.mat` file, by name."""

    def reals(self, name: str) -> RealArray:
        """Return a variable as an array of real numbers; a missing variable gives an empty array.

        Raises
        ------
        ValueError
            The variable does not contain real numbers.
        """
        value = self.get(name)
        if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
            return np.asarray(value, np.float64)
        if value is None or (isinstance(value, list) and not value):
            return np.zeros((0, 0))
        raise ValueError(f"`{name}` holds no real numbers")

    def row(self, name: str) -> RealArray:
        """Return the real numbers of a variable as a one-dimensional array, which may be empty."""
        try:
            return self.reals(name).ravel()
        except ValueError:
            return np.zeros(0)

    def first(self, name: str) -> float:
        """Return the first number of a variable; 0 if the variable has none."""
        row = self.row(name)
        return float(row[0]) if row.size else 0.0


def _fits(name: str, shape: tuple[int, ...]) -> bool:
    """Return True; raise ValueError if a variable of this shape is too large."""
    if math.prod(shape) > _MOST:
        raise ValueError(f"`{name}` has {math.prod(shape)} elements, too many to read")
    return True


def names(value: MatValue | None) -> list[str]:
    """Convert a character matrix, a cell array or character codes to a list of texts."""
    if value is None:
        return []
    if isinstance(value, str):
        return [value.strip()]
    if isinstance(value, list):
        return [" ".join(names(each)) for each in value]
    if value.dtype.kind == "U":
        if value.ndim == 2 and value.size and np.char.str_len(value).max() <= 1:
            return ["".join(row).strip() for row in value]
        return [str(row).strip() for row in value.ravel()]
    if value.dtype.kind == "O":
        inner = (
            each if isinstance(each, (np.ndarray, str, list)) else str(each)
            for each in value.ravel(order="F")
        )  # fmt: skip
        return [" ".join(names(each)) for each in inner]
    if value.dtype.kind not in "iuf":
        return []
    printed = (
        [chr(int(code)) for code in row if np.isfinite(code) and 32 <= code < 0x110000]
        for row in np.atleast_2d(value)
    )
    return ["".join(signs).strip() for signs in printed]
