"""The identity of a function, to detect changes: its code, and the values that it holds."""

from __future__ import annotations

import copyreg
import functools
import hashlib
import inspect
import types
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np

# Objects that are looked at, and how deep they may lie in each other; the rest counts by its type.
_MOST, _DEEPEST = 200_000, 60
# Entries of a container that count one by one.
_SPLIT = 1000
_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(Ellipsis))
# What is known by its name.
_BY_NAME = (type, types.ModuleType, types.BuiltinFunctionType, np.ufunc, np.dtype)


def fingerprint(function: Callable[..., Any], held: Mapping[str, str]) -> str:
    """The name of the function, and a digest of its code, constants and defaults, and of what it holds (see `holdings`)."""
    digest = hashlib.sha256()
    inner = _inner(function)
    _digest_code(_code_of(inner), digest)
    for part in (getattr(inner, "__defaults__", None), getattr(function, "args", None)):
        digest.update(_words(part).encode())
    for path, of in sorted(held.items()):
        digest.update(f"{path}={of};".encode())
    name = getattr(inner, "__qualname__", type(inner).__qualname__)
    return f"{getattr(inner, '__module__', None)}.{name} {digest.hexdigest()[:16]}"


def holdings(function: Callable[..., Any], quantiles: Iterable[tuple[str, Any]] = ()) -> dict[str, str]:
    """Digests of the values that a function holds, by where it holds them: variables of enclosing functions, defaults, arguments of
    `functools.partial`, attributes of the object that it is or belongs to, decorators around it; and of (factor, quantile
    function) what the quantiles are. Nothing of a plain function, whose code and simple defaults say all."""
    walk = _Walk(_inner(function))
    walk.split(function, "", ())
    for name, quantile in quantiles:
        identity = getattr(quantile, "identity", None)
        walk.split(quantile if identity is None else identity(), f"quantile of {name}", ())
    return walk.parts


def constant(held: Mapping[str, str], changing: set[str]) -> dict[str, str]:
    """The held values that calls do not change: those at other places than `changing`, and in containers that do not grow or shrink."""
    grown = tuple(path[:-1] for path in changing if path.endswith("[]"))
    return {path: of for path, of in held.items() if path not in changing and not path.startswith(grown)}


def _inner(function: Any) -> Any:
    """The innermost function, without decorators and a `functools.partial`."""
    return inspect.unwrap(getattr(function, "func", function))


def _code_of(function: Any) -> Any:
    return getattr(function, "__code__", None) or getattr(getattr(function, "__call__", None), "__code__", None)


def _words(value: Any) -> str:
    """The value as text that is the same in every process."""
    if isinstance(value, (tuple, list)):
        return "(" + ",".join(_words(part) for part in value) + ")"
    if isinstance(value, (set, frozenset)):
        return "{" + ",".join(sorted(_words(part) for part in value)) + "}"
    return repr(value) if isinstance(value, (int, float, complex, str, bytes, type(None))) else type(value).__qualname__


def _are_words(value: Any) -> bool:
    """Whether `_words` describes a value completely."""
    if isinstance(value, (tuple, list, set, frozenset)):
        return all(map(_are_words, value))
    return type(value) in (bool, int, float, complex, str, bytes, type(None))


def _digest_code(code: Any, digest: Any) -> None:
    if code is None:
        return
    digest.update(code.co_code)
    digest.update(_words(code.co_names + code.co_varnames).encode())
    for constant in code.co_consts:
        if hasattr(constant, "co_code"):
            _digest_code(constant, digest)
        else:
            digest.update(_words(constant).encode())


class _Walk:
    """Goes through what a function holds. `parts` are digests by path, each of a value that can change on its own; the code and
    the simple defaults of the function `known` are left out."""

    def __init__(self, known: Any = None, left: list[int] | None = None):
        self.known = known
        self.parts: dict[str, str] = {}
        # Shared by all walks inside a walk.
        self.left = [_MOST] if left is None else left

    def split(self, value: Any, path: str, above: tuple[int, ...]) -> None:
        """Adds the parts of `value`, which is at `path` inside the objects `above` (by `id`)."""
        inside = (*above, id(value))
        is_data = not callable(value) and isinstance(value, (*_PLAIN, *_CONTAINERS))
        if id(value) in above or len(above) > _DEEPEST or is_data and not _is_split(value):
            self._leaf(value, path, above)
            return
        if is_data:
            entries = list(value.items() if isinstance(value, dict) else enumerate(value))
            self._leaf([type(value), *sorted(key for key, _ in entries)], f"{path}[]", above)
            for key, entry in entries:
                self.split(entry, f"{path}[{key!r}]", inside)
            return
        if isinstance(value, _BY_NAME):
            if value is not self.known:
                self._leaf(value, path, above)
        elif isinstance(value, functools.partial):
            self.split(value.func, f"{path}.func", inside)
            # Simple ones of the function itself are known.
            if above or not _are_words(value.args):
                self.split(value.args, f"{path}.args", inside)
            for name, given in value.keywords.items():
                self.split(given, f"{path}.{name}", inside)
        elif isinstance(value, types.MethodType):
            self._code(value.__func__, path) if value is not self.known else None
            self._function(value.__func__, path, inside)
            self.split(value.__self__, f"{path}.self", inside)
        elif isinstance(value, types.FunctionType):
            self._code(value, path) if value is not self.known else None
            self._function(value, path, inside)
        else:
            self._object(value, path, inside)

    def _leaf(self, value: Any, path: str, above: tuple[int, ...]) -> None:
        digest = hashlib.sha256()
        self._feed(digest, value, above)
        self.parts[path] = digest.hexdigest()

    def _code(self, function: Any, path: str) -> None:
        digest = hashlib.sha256()
        _digest_code(function.__code__, digest)
        digest.update(_words(function.__defaults__).encode())
        self.parts[f"{path}.code"] = digest.hexdigest()

    def _function(self, function: Any, path: str, inside: tuple[int, ...]) -> None:
        for place, default in enumerate(function.__defaults__ or ()):
            if not _are_words(default):
                self.split(default, f"{path}.default {place}", inside)
        for name, default in (function.__kwdefaults__ or {}).items():
            self.split(default, f"{path}.default {name}", inside)
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or ()):
            try:
                contents = cell.cell_contents
            except ValueError:  # not set yet
                continue
            self.split(contents, f"{path}.{name}", inside)
        for name, attribute in vars(function).items():
            self.split(attribute, f"{path}.{name}", inside)

    def _object(self, value: Any, path: str, inside: tuple[int, ...]) -> None:
        """An object of a class: the data that pickle would store, otherwise its attributes, otherwise its type."""
        call = getattr(type(value), "__call__", None)
        if isinstance(call, types.FunctionType) and value is not self.known:
            self._code(call, path)
        wrapped = getattr(value, "__wrapped__", None)
        if wrapped is not None:
            self.split(wrapped, f"{path}.wrapped", inside)
        # Compilers of functions store what differs between processes, in addition to the function itself.
        of: Any = type(value)
        is_own = of.__reduce__ is object.__reduce__ and of.__reduce_ex__ is object.__reduce_ex__
        stored = _stored(value) if wrapped is None or is_own else type(value).__qualname__
        digest = hashlib.sha256(f"{type(value).__module__}.{type(value).__qualname__}".encode())
        if isinstance(stored, tuple):
            make, arguments, state, items, pairs = (*stored, None, None, None)[:5]
            for part in (make, arguments, list(items or ()), dict(pairs or ())):
                self._feed(digest, part, inside)
            # Attributes, and those of slots.
            states = state if isinstance(state, tuple) and len(state) == 2 else (state,)
            if all(of is None or isinstance(of, dict) for of in states):
                for name, attribute in (pair for of in states for pair in (of or {}).items()):
                    self.split(attribute, f"{path}.{name}", inside)
            else:
                self._feed(digest, state, inside)
        else:
            self._feed(digest, stored, inside)
            for name, attribute in (getattr(value, "__dict__", {}) if stored is None else {}).items():
                self.split(attribute, f"{path}.{name}", inside)
        if value is not self.known or not isinstance(stored, str):
            self.parts[path] = digest.hexdigest()

    def _feed(self, digest: Any, value: Any, above: tuple[int, ...]) -> None:
        self.left[0] -= 1
        digest.update(f"{type(value).__qualname__}:".encode())
        if self.left[0] < 0 or len(above) > _DEEPEST:
            return
        if id(value) in above:
            digest.update(f"{len(above) - above.index(id(value))} above;".encode())
            return
        inside = (*above, id(value))
        if isinstance(value, _PLAIN):
            digest.update(f"{value!r};".encode("utf-8", "surrogatepass"))
        elif isinstance(value, np.ma.MaskedArray):
            self._feed(digest, (np.ma.getdata(value), np.ma.getmaskarray(value)), inside)
        elif isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind != "O":
            digest.update(f"{value.dtype} {value.shape}:".encode())
            digest.update(value.tobytes())
        elif isinstance(value, np.ndarray):
            self._feed(digest, (value.shape, value.ravel().tolist()), inside)
        elif isinstance(value, (list, tuple)) and all(type(part) in _PLAIN for part in value):
            digest.update(f"{value!r};".encode("utf-8", "surrogatepass"))
        elif isinstance(value, (list, tuple)):
            digest.update(f"{len(value)}:".encode())
            for part in value:
                self._feed(digest, part, inside)
        elif isinstance(value, (set, frozenset)):
            digest.update("".join(sorted(self._digest(part, inside) for part in value)).encode())
        elif isinstance(value, (dict, types.MappingProxyType)):
            entries = [(self._digest(key, inside), of) for key, of in value.items()]
            for key, of in sorted(entries, key=lambda entry: entry[0]):
                digest.update(key.encode())
                self._feed(digest, of, inside)
        elif isinstance(value, (bytearray, memoryview)):
            digest.update(bytes(value))
        elif isinstance(value, types.CodeType):
            _digest_code(value, digest)
        elif isinstance(value, _BY_NAME):
            module = getattr(value, "__module__", None)
            digest.update(f"{module}.{getattr(value, '__qualname__', getattr(value, '__name__', value))};".encode())
        else:
            walk = _Walk(left=self.left)
            walk.split(value, "", above)
            digest.update(repr(sorted(walk.parts.items())).encode())

    def _digest(self, value: Any, above: tuple[int, ...]) -> str:
        digest = hashlib.sha256()
        self._feed(digest, value, above)
        return digest.hexdigest()


_CONTAINERS = (
    list,
    tuple,
    set,
    frozenset,
    dict,
    types.MappingProxyType,
    bytearray,
    memoryview,
    np.ndarray,
    np.generic,
    types.CodeType,
)


def _is_split(value: Any) -> bool:
    """Whether the entries of a container count separately: calls may change one of them."""
    if isinstance(value, dict):
        return 0 < len(value) <= _SPLIT and all(type(key) is str for key in value)
    return isinstance(value, (list, tuple)) and len(value) <= _SPLIT and any(type(part) not in _PLAIN for part in value)


def _stored(value: Any) -> Any:
    """The data that pickle would store of an object: its construction, or its name; None if it cannot be stored."""
    try:
        reduce = copyreg.dispatch_table.get(type(value))
        return reduce(value) if reduce is not None else value.__reduce_ex__(4)
    except Exception:
        return None
