# SPDX-License-Identifier: Apache-2.0
"""Short errors for wrong arguments of the functions of relief._relief.

pybind11 prints the values of all arguments. Here the error names the wrong keyword and the nearest right one, or
the types of the arguments.
"""
from __future__ import annotations

import difflib
import functools
import inspect
import re
from collections.abc import Callable
from typing import Any


def _type_name(value: Any) -> str:
    return type(value).__name__


def _message(name: str, error: str, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> str | None:
    """The short form of an error of pybind11; None for other errors."""
    if "incompatible function arguments" not in error and "incompatible constructor arguments" not in error:
        return None
    expected = error.partition("\nInvoked with: ")[0]
    known = [word for word in re.findall(r"[(,] ?(\w+): ", expected) if word != "self"]
    for keyword in keywords:
        if keyword not in known:
            nearest = difflib.get_close_matches(keyword, known, 1)
            hint = f"did you mean '{nearest[0]}'?" if nearest else f"its arguments are {', '.join(known)}"
            return f"{name}() has no argument '{keyword}': {hint}"
    given = [_type_name(value) for value in arguments]
    given += [f"{keyword}: {_type_name(value)}" for keyword, value in keywords.items()]
    signatures = re.findall(r"^    \d+\. [\w.]*\((?:self: [^,)]*(?:, )?)?(.*)\)(?: -> .*)?$", expected, re.MULTILINE)
    return f"{name}() got ({', '.join(given)}), expected ({') or ('.join(signatures)})"


def _shortened(function: Callable[..., Any], name: str, *, is_method: bool) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            message = _message(name, str(error), arguments[is_method:], keywords)
            if message is None:
                raise
        raise TypeError(message)

    call.__module__ = "relief"
    call.__qualname__ = name
    return call


def shorten_errors(names: dict[str, Any]) -> None:
    """Replace the functions of relief._relief in a namespace, and the methods of its classes."""
    for name, value in list(names.items()):
        if getattr(value, "__module__", None) != "relief._relief":
            continue
        if inspect.isbuiltin(value):
            names[name] = _shortened(value, name, is_method=False)
        elif inspect.isclass(value) and not issubclass(value, BaseException):
            _shorten_methods(value)


def _shorten_methods(kind: type) -> None:
    for name, member in list(vars(kind).items()):
        if name.startswith("__") and name != "__init__":
            continue
        function = getattr(kind, name)
        if not callable(function):
            continue
        shown = kind.__name__ if name == "__init__" else f"{kind.__name__}.{name}"
        is_static = isinstance(member, staticmethod)
        short = _shortened(function, shown, is_method=not is_static)
        setattr(kind, name, staticmethod(short) if is_static else short)
