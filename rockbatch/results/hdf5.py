"""Read untrusted HDF5 files: only data stored in the file itself, in sizes that the file can hold.

HDF5 allows links into other files, datasets stored in other files (external) or composed of other datasets (virtual), and
sizes without bytes. All these raise ``ValueError`` here. The low-level API of h5py is used since its lookups are four times
as fast.
"""

from typing import Any

import numpy as np

from rockbatch.common.lazy import h5py

_TYPES = {"f": np.float64, "i": np.int64, "S": np.str_}

MOST_OF_A_TEXT = 10_000_000
"""Most characters of an attribute; the longest is the study's text."""


def group_in(group: "h5py.Group", name: str) -> "h5py.Group":
    """Return the subgroup ``name`` of ``group``; raise ``ValueError`` if missing or a link to elsewhere."""
    member = _member(group, name)
    if not isinstance(member, h5py.h5g.GroupID):
        raise ValueError(f"{name} is not a group")
    return h5py.Group(member)


def array_in(
    group: "h5py.Group", name: str, kind: str, length: int | None = None, *, finite: bool = True
) -> "np.ndarray":
    """Return the one-dimensional dataset ``name`` of ``group``: float64, int64 or ASCII texts for ``kind`` "f", "i" or "S".

    Raises ``ValueError`` if it is missing, stored elsewhere or in chunks, larger than the file, of another kind or ``length``, or
    has infinite values that ``finite`` excludes; NaN is allowed.
    """
    member = _member(group, name)
    if not isinstance(member, h5py.h5d.DatasetID) or member.rank != 1 or (dtype := member.dtype).kind != kind:
        raise ValueError(f"{name} is not a list of {'texts' if kind == 'S' else 'numbers'}")
    layout = member.get_create_plist()
    if layout.get_external_count() or layout.get_layout() in (h5py.h5d.VIRTUAL, h5py.h5d.CHUNKED):
        raise ValueError(f"{name} is not stored as `rockbatch` stores it")
    (size,) = member.shape
    if member.get_storage_size() != size * dtype.itemsize or size * dtype.itemsize > _size(group):
        raise ValueError(f"{name} claims {size} values, more than the file holds")
    if length is not None and size != length:
        raise ValueError(f"{name} has {size} values instead of {length}")
    values = np.empty(size, dtype)
    member.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
    if kind == "f" and finite and np.isinf(values).any():
        raise ValueError(f"{name} has infinite values")
    return values.astype(_TYPES[kind], copy=False)


def attributes_of(item: "h5py.Group") -> dict[str, Any]:
    """Return the attributes of a group by name, as Python numbers and texts; ``ValueError`` if one is anything else."""
    return {name: attribute(item, name) for name in item.attrs}


def attribute(item: "h5py.Group", name: str) -> Any:
    """Return an attribute as a Python number or text; None if missing; raise ``ValueError`` if it is anything else."""
    encoded = _encoded(name)
    if not h5py.h5a.exists(item.id, encoded):
        return None
    stored = h5py.h5a.open(item.id, encoded)
    if stored.shape != () or (dtype := stored.dtype).kind not in "fiubO":
        raise ValueError(f"the attribute {name} is neither a number nor a text")
    stored.read(content := np.zeros((), dtype))
    value = content.item()
    if isinstance(value, bytes):
        value = value.decode(errors="surrogateescape")
    if not isinstance(value, str | int | float) or (isinstance(value, str) and len(value) > MOST_OF_A_TEXT):
        raise ValueError(f"the attribute {name} is neither a number nor a text")
    return value


def _member(group: "h5py.Group", name: str) -> "h5py.h5g.GroupID | h5py.h5d.DatasetID":
    """Return the object ``name`` of a group by a hard link; raise ``ValueError`` for other links."""
    encoded = _encoded(name)
    if not group.id.links.exists(encoded):
        raise ValueError(f"{name} is missing")
    if group.id.links.get_info(encoded).type != h5py.h5l.TYPE_HARD:
        raise ValueError(f"{name} is a link that leads elsewhere")
    return h5py.h5o.open(group.id, encoded)


def _encoded(name: str) -> bytes:
    return name.encode(errors="surrogateescape")


def _size(group: "h5py.Group") -> int:
    return int(h5py.h5i.get_file_id(group.id).get_filesize())
