"""Arrays and tables of others as arrays of numbers: what is masked or missing is NaN, and columns go by their names."""

from __future__ import annotations

import dataclasses
import numbers as kinds
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._engine import StudyError


def numbers(values: Any, what: str, error: type[Exception] = StudyError) -> np.ndarray:
    """`values` as an array of floats of the same shape, NaN where they are masked, None or `pandas.NA`.

    `error` says of `what` that it holds something else than real numbers.
    """
    if isinstance(values, np.ma.MaskedArray):
        return np.where(np.ma.getmaskarray(values), np.nan, numbers(values.data, what, error))
    wrong: Any = None
    try:
        array = np.asarray(values)
        if array.dtype.kind == "O":
            found = [_number(wrong := value) for value in array.ravel()]
            array = np.array(found, dtype=float).reshape(array.shape)
        elif array.dtype.kind not in "fiub":
            wrong = array.ravel()[0].item() if array.size else array.dtype
            raise TypeError
    except (TypeError, ValueError):
        raise error(f"{what} {values if wrong is None else wrong!r:.80}: expected real numbers") from None
    return array.astype(float, copy=False)


def _number(value: Any) -> float:
    if value is None or value is np.ma.masked or type(value).__name__ == "NAType":
        return np.nan
    if isinstance(value, (kinds.Real, np.bool_)) or hasattr(value, "__float__"):
        return float(value)
    raise TypeError(f"{value!r} is not a real number")


def named(data: Any, what: str, error: type[Exception] = StudyError) -> dict[str, np.ndarray] | None:
    """The columns of a mapping, of a named tuple, of a dataclass or of a frame (whatever has `columns`) by their names, as numbers.

    None if there are no names: of arrays, and of frames whose columns are numbered 0, 1, ... as those made of an array are.
    `error` says of `what` that there are no columns, or two of the same name, or which one holds no numbers.
    """
    if dataclasses.is_dataclass(data) and not isinstance(data, type):
        data = vars(data) if hasattr(data, "__dict__") else dataclasses.asdict(data)
    elif isinstance(data, tuple) and hasattr(data, "_asdict"):
        data = data._asdict()
    if isinstance(data, Mapping):
        names = list(data)
    elif hasattr(data, "columns") and hasattr(data, "__getitem__"):
        # The `columns` of Arrow's tables are the values.
        names = list(getattr(data, "column_names", data.columns))
        if names and all(isinstance(name, (int, np.integer)) for name in names) and names == list(range(len(names))):
            return None
    else:
        return None
    texts = [str(name) for name in names]
    again = [name for name, count in Counter(texts).items() if count > 1]
    if again:
        raise error(f"{what} two columns with the name {again[0]!r}: their names must differ")
    return {text: numbers(data[name], f"{what} in the column {text!r}", error) for text, name in zip(texts, names)}


def in_order(data: Any) -> Any:
    """Series and frames of pandas by their index, if it numbers the rows in another order; `data` itself otherwise."""
    index = getattr(data, "index", None)
    if not hasattr(data, "sort_index") or getattr(index, "dtype", None) != np.int64:
        return data
    places = np.asarray(index)
    if np.array_equal(places, np.arange(len(places))) or not np.array_equal(np.sort(places), np.arange(len(places))):
        return data
    return data.sort_index()


def series_name(data: Any) -> str | None:
    """The name of a series of pandas or polars."""
    name = getattr(data, "name", None) if hasattr(data, "to_frame") and not hasattr(data, "columns") else None
    return name if isinstance(name, str) and name else None


def placed(columns: Mapping[str, Any], expected: Sequence[str], what: str) -> list[Any]:
    """The `columns` in the order of `expected`; a `StudyError` says of `what` which are missing and which are none of them."""
    known = set(expected)
    missing = [name for name in expected if name not in columns]
    strange = [name for name in columns if name not in known]
    if missing or strange:
        wrong = [f"without {', '.join(missing)}"] * bool(missing) + [f"with {', '.join(strange)}"] * bool(strange)
        raise StudyError(f"{what} {' and '.join(wrong)}: expected the columns {', '.join(expected)}, in any order")
    return [columns[name] for name in expected]
