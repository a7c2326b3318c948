"""Files of Mooring Design & Dynamics in each dialect that people have, made for the tests."""

import h5py
import numpy as np
from scipy.io import savemat

NAMES = ["37 in ball", "1/2 shackle", "3/8 wire rope", "Current meter", "AR 861", "1/2 chain",
         "Two wheels"]  # fmt: skip
HEIGHT = [
    [0.94, 0.08, 80.0, 0.55, 0.94, 5.0, 0.35],
    [0.0, 0.025, 0.009, 0.128, 0.13, 0.03, 1.0],
    [0.94, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0],
]


def mooring(**changes):
    """The variables of a small mooring in 120 m of water, with a clamp; some changed."""
    variables = {
        "U": np.array([[0.8, 0.3, 0.0]]),
        "V": np.array([[0.0, 0.1, 0.0]], np.float64),
        "W": np.zeros((1, 3), np.uint8),
        "z": np.array([[120, 30, 0]], np.uint8),
        "rho": np.array([[1025, 1025, 1025]], np.uint16),
        "time": np.zeros((0, 0)),
        "H": np.array(HEIGHT),
        "B": np.array([[300.0, -0.3, -0.33, -18.3, -28.0, -4.0, 915.0]]),
        "Cd": np.array([[0.65, 1.3, 1.3, 1.3, 1.2, 1.3, 1.3]]),
        "ME": np.array([[np.inf, np.inf, 1.38e11, np.inf, np.inf, np.inf, np.inf]]),
        "moorele": NAMES,
        "HCO": np.array([[0.45], [0.08], [0.0], [0.0]]),
        "BCO": np.array([[-10]], np.int16),
        "CdCO": np.array([[1.3]]),
        "ZCO": np.array([[62.84]]),
        "Jobj": np.array([[3]], np.uint8),
        "Pobj": np.array([[0.7]]),
        "mooreleCO": ["SBE-16"],
    }
    for name, value in changes.items():
        if value is None:
            variables.pop(name, None)
        else:
            variables[name] = value
    return variables


def tow(**changes):
    """A sphere towed on a wire at 1 m/s, with the mark at the ship that the program adds."""
    variables = {
        "U": np.zeros((3, 1), np.uint8),
        "V": np.zeros((1, 3), np.uint8),
        "W": np.zeros((1, 3), np.uint8),
        "z": np.array([[0.0, 10.0, 200.0]]),
        "rho": np.array([[1024, 1025, 1026]], np.uint16),
        "time": np.zeros((0, 0)),
        "Ht": np.array([[0.3, 100.0, 0.001], [0, 0.007, 0], [0.3, 0, 0.001], [0, 1, 0]]),
        "Bt": np.array([[-100.0, -0.009, 0.01]]),
        "Cdt": np.array([[0.65, 1.3, 0.01]]),
        "MEt": np.array([[np.inf, 6.9e10, np.inf]]),
        "moorelet": ["Heavy sphere", "1/4 Kevlar", "Top of Tow Rope"],
        "Usp": np.array([[0.6]]),
        "Vsp": np.array([[0.8]]),
        "afh": np.array([[5]], np.uint8),
    }
    return variables | changes


def characters(texts):
    """Texts as the rows of a matrix of codes."""
    width = max(len(text) for text in texts)
    return np.array([[ord(sign) for sign in text.ljust(width)] for text in texts])


def write_matlab(path, variables, version="5", names="char"):
    """MATLAB 4 or 5; names as a character matrix, a cell array or codes."""
    shown = {}
    for name, value in variables.items():
        if not isinstance(value, list):
            value = np.asarray(value, np.float64) if version == "4" else value
        elif names == "cell":
            cell = np.empty((len(value), 1), object)
            cell[:, 0] = value
            value = cell
        elif names == "uint16":
            value = characters(value).astype(np.uint16)
        else:
            value = np.array([text.ljust(16) for text in value])
        if not (version == "4" and np.size(value) == 0):
            shown[name] = value
    savemat(path, shown, format=version)


def write_hdf5(path, variables, names="char"):
    """MATLAB 7.3: matrices turned round, characters as codes, cells as references."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, value in variables.items():
            if isinstance(value, list) and names == "cell":
                references = []
                for number, text in enumerate(value):
                    each = file.create_dataset(
                        f"#refs#/{name}{number}", data=characters([text]).T.astype(np.uint16)
                    )
                    each.attrs["MATLAB_class"] = np.bytes_("char")
                    references.append(each.ref)
                data = file.create_dataset(
                    name, data=np.array([references], h5py.ref_dtype), dtype=h5py.ref_dtype
                )
                data.attrs["MATLAB_class"] = np.bytes_("cell")
            elif isinstance(value, list):
                data = file.create_dataset(name, data=characters(value).T.astype(np.uint16))
                data.attrs["MATLAB_class"] = np.bytes_("char")
            elif value.size == 0:
                data = file.create_dataset(name, data=np.zeros(2, np.uint64))
                data.attrs["MATLAB_class"] = np.bytes_("double")
                data.attrs["MATLAB_empty"] = 1
            else:
                data = file.create_dataset(name, data=value.T)
                data.attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(128))


def write_version_4(path, variables):
    """MATLAB 4 of a machine with the other order of bytes; names as a character matrix."""
    content = b""
    for name, value in variables.items():
        text = isinstance(value, list)
        array = characters(value) if text else np.atleast_2d(value)
        head = (1001 if text else 1000, *array.shape, 0, len(name) + 1)
        content += np.array(head, ">i4").tobytes() + name.encode() + b"\0"
        content += array.astype(">f8").tobytes(order="F")
    path.write_bytes(content)


def write_octave_hdf5(path, variables, names="char"):
    """Octave's HDF5: a group a variable, its dimensions turned round; cells are groups, too."""
    with h5py.File(path, "w") as file:
        for name, value in variables.items():
            group = file.create_group(name)
            if not isinstance(value, list):
                group["type"] = np.bytes_("matrix")
                group["value"] = value.T
                if value.size == 0:
                    group["value"].attrs["OCTAVE_EMPTY_MATRIX"] = 1
            elif names == "cell":
                group["type"] = np.bytes_("cell")
                cell = group.create_group("value")
                cell["dims"] = [len(value), 1]
                for number, text in enumerate(value):
                    element = cell.create_group(f"_{number}")
                    element["type"] = np.bytes_("sq_string")
                    element["value"] = characters([text]).T.astype(np.int8)
            else:
                group["type"] = np.bytes_("sq_string")
                group["value"] = characters(value).T.astype(np.int8)


def octave_text(variables, colon=":", rows=None):
    """Octave's text, its headers with or without a colon, or with a wrong number of rows."""
    lines = ["# Created by Octave 8.3.0, Sat Nov 11 01:53:14 2023 PST <someone@somewhere>"]
    for name, value in variables.items():
        lines.append(f"# name: {name}")
        if isinstance(value, list):
            lines += ["# type: global sq_string", f"# elements: {len(value)}"]
            for text in value:
                lines += [f"# length: {len(text)}", text]
        else:
            value = np.atleast_2d(value)
            lines += ["# type: global matrix", f"# rows: {rows or value.shape[0]}"]
            lines.append(f"# columns{colon} {value.shape[1]}")
            for row in value:
                words = ["Inf" if np.isinf(number) else repr(float(number)) for number in row]
                lines.append(" " + " ".join(words))
        lines += ["", ""]
    return "\n".join(lines)
