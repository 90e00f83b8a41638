"""The only access to HDF5 files, which may be untrusted: data in the file itself, in shapes that fit into it.

HDF5 can lead elsewhere: links into other files, datasets whose bytes are in other files (external storage) or in other
datasets (virtual ones), and sizes without bytes behind them. All these raise ``ValueError`` here. h5py's own lookups take
four times as long as those of its lower level.
"""

from typing import Any

import numpy as np

from rockbatch.common.lazy import h5py

MOST_OF_A_TEXT = 10_000_000
"""Characters of a text that is kept in an attribute: the study's is the longest."""


def group_in(group: "h5py.Group", name: str) -> "h5py.Group":
    """Return a group that lies in ``group`` itself."""
    member = _member(group, name)
    if not isinstance(member, h5py.h5g.GroupID):
        raise ValueError(f"{name} is no group")
    return h5py.Group(member)


def array_in(
    group: "h5py.Group", name: str, kind: str, length: int | None = None, *, finite: bool = True
) -> "np.ndarray[Any, Any]":
    """Return a dataset of one dimension that lies in ``group``, with its bytes: numbers of ``kind`` "f" or "i", or texts "S".

    Texts come as ``str``. ``length`` is the number of values that there have to be; ``finite`` ones unless they may be infinite.
    """
    member = _member(group, name)
    if not isinstance(member, h5py.h5d.DatasetID) or member.rank != 1 or (dtype := member.dtype).kind != kind:
        raise ValueError(f"{name} is no list of {'texts' if kind == 'S' else 'numbers'}")
    made = member.get_create_plist()
    if made.get_external_count() or made.get_layout() in (h5py.h5d.VIRTUAL, h5py.h5d.CHUNKED):
        raise ValueError(f"the bytes of {name} are not where `rockbatch` writes them")
    (size,) = member.shape
    if member.get_storage_size() != size * dtype.itemsize or size * dtype.itemsize > _size(group):
        raise ValueError(f"{name} has {size} values, and no room for them in the file")
    if length is not None and size != length:
        raise ValueError(f"{name} has {size} values instead of {length}")
    if kind == "S":
        return np.asarray(h5py.Dataset(member).asstr()[:])
    values = np.empty(size, dtype)
    member.read(h5py.h5s.ALL, h5py.h5s.ALL, values)
    if kind == "f" and finite and np.isinf(values).any():
        raise ValueError(f"{name} has infinite values")
    return values


def attributes_of(item: "h5py.Group") -> dict[str, Any]:
    """Return the attributes of a group, as Python's own numbers and texts."""
    return {name: attribute(item, name) for name in item.attrs}


def attribute(item: "h5py.Group", name: str) -> Any:
    """Return one attribute, as Python's own number or text; None if it is missing."""
    encoded = _encoded(name)
    if not h5py.h5a.exists(item.id, encoded):
        return None
    stored = h5py.h5a.open(item.id, encoded)
    if stored.shape != () or (dtype := stored.dtype).kind not in "fiubO":
        raise ValueError(f"the attribute {name} is neither a number nor a text")
    if dtype.kind == "O":
        value = item.attrs[name]
    else:
        stored.read(number := np.zeros((), dtype))
        value = number.item()
    if not isinstance(value, str | int | float) or (isinstance(value, str) and len(value) > MOST_OF_A_TEXT):
        raise ValueError(f"the attribute {name} is neither a number nor a text")
    return value


def _member(group: "h5py.Group", name: str) -> "h5py.h5g.GroupID | h5py.h5d.DatasetID":
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
