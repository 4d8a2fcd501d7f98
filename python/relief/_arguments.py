# SPDX-License-Identifier: Apache-2.0
"""Signatures and short errors for the functions of relief._relief.

pybind11 knows no types of arrays, and its errors print the values of all arguments. Here _relief.pyi gives the
functions their signatures, and an error names the wrong keyword and the nearest right one, or the types of the
arguments.
"""
from __future__ import annotations

import ast
import difflib
import functools
import inspect
import pathlib
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


class _Text(str):
    """An annotation, which signatures show without quotes."""

    __slots__ = ()
    __repr__ = str.__str__


def _parameter(argument: ast.arg, kind: Any, default: ast.expr | None) -> inspect.Parameter:
    return inspect.Parameter(
        argument.arg, kind,
        default=inspect.Parameter.empty if default is None else ast.literal_eval(default),
        annotation=_Text(ast.unparse(argument.annotation)) if argument.annotation else inspect.Parameter.empty)


def _signature(function: ast.FunctionDef) -> inspect.Signature:
    arguments = function.args
    absent: list[ast.expr | None] = [None] * (len(arguments.args) - len(arguments.defaults))
    parameters = [_parameter(argument, inspect.Parameter.POSITIONAL_OR_KEYWORD, default)
                  for argument, default in zip(arguments.args, [*absent, *arguments.defaults], strict=True)]
    if arguments.vararg:
        parameters.append(_parameter(arguments.vararg, inspect.Parameter.VAR_POSITIONAL, None))
    parameters += [_parameter(argument, inspect.Parameter.KEYWORD_ONLY, default)
                   for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)]
    result = _Text(ast.unparse(function.returns)) if function.returns else inspect.Signature.empty
    return inspect.Signature(parameters, return_annotation=result)


@functools.cache
def _stated_signatures() -> dict[str, inspect.Signature]:
    """The signatures in the stub: of "bump", "Mesh.__init__" and so on."""
    stub = ast.parse((pathlib.Path(__file__).parent / "_relief.pyi").read_text(encoding="utf-8"))
    signatures = {}
    for node in stub.body:
        if isinstance(node, ast.FunctionDef):
            signatures[node.name] = _signature(node)
        elif isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    signatures[f"{node.name}.{member.name}"] = _signature(member)
    return signatures


class _StatedSignature(inspect.Signature):
    """The signature of a name in the stub, which is parsed for help() and for errors, and not on import."""

    __slots__ = ("_name",)

    def __init__(self, name: str) -> None:
        self._name = name

    @property
    def parameters(self) -> Mapping[str, inspect.Parameter]:  # type: ignore[override]
        return _stated_signatures()[self._name].parameters

    @property
    def return_annotation(self) -> Any:
        return _stated_signatures()[self._name].return_annotation

    def replace(self, **changes: Any) -> inspect.Signature:  # type: ignore[override]
        return _stated_signatures()[self._name].replace(**changes)


def _unknown_keyword(name: str, signature: inspect.Signature, keywords: dict[str, Any]) -> str | None:
    known = [word for word in signature.parameters if word != "self"]
    for keyword in keywords:
        if keyword not in known:
            nearest = difflib.get_close_matches(keyword, known, 1)
            hint = f"did you mean '{nearest[0]}'?" if nearest else f"its arguments are {', '.join(known)}"
            return f"{name}() has no argument '{keyword}': {hint}"
    return None


def _without_self(signature: inspect.Signature) -> inspect.Signature:
    return signature.replace(parameters=[p for p in signature.parameters.values() if p.name != "self"])


def _message(name: str, signature: inspect.Signature, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> str:
    """The short form of an error of pybind11."""
    unknown = _unknown_keyword(name, signature, keywords)
    if unknown is not None:
        return unknown
    try:
        signature.bind(*arguments, **keywords)
    except TypeError as error:
        return f"{name}(): {error}; expected {name}{signature}"
    given = [type(value).__name__ for value in arguments]
    given += [f"{keyword}: {type(value).__name__}" for keyword, value in keywords.items()]
    return f"{name}() got ({', '.join(given)}), expected {signature}"


def _shortened(
    function: Callable[..., Any], name: str, signature: inspect.Signature, *, is_method: bool
) -> Callable[..., Any]:
    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            text = str(error)
            if "incompatible function arguments" not in text and "incompatible constructor arguments" not in text:
                raise
        raise TypeError(_message(name, _without_self(signature), arguments[is_method:], keywords))

    call.__module__ = "relief"
    call.__qualname__ = name
    call.__signature__ = signature  # type: ignore[attr-defined]
    return call


def checks_keywords(function: Function) -> Function:
    """Let a function name the nearest argument for an unknown keyword."""
    signature = inspect.signature(function)
    signature = signature.replace(
        parameters=[p.replace(annotation=_Text(p.annotation)) for p in signature.parameters.values()],
        return_annotation=_Text(signature.return_annotation))

    @functools.wraps(function)
    def call(*arguments: Any, **keywords: Any) -> Any:
        unknown = _unknown_keyword(function.__name__, signature, keywords)
        if unknown is not None:
            raise TypeError(unknown)
        return function(*arguments, **keywords)

    call.__signature__ = signature  # type: ignore[attr-defined]
    return call  # type: ignore[return-value]


def shorten_errors(names: dict[str, Any]) -> None:
    """Replace the functions of relief._relief in a namespace, and the methods of its classes."""
    for name, value in list(names.items()):
        if getattr(value, "__module__", None) != "relief._relief":
            continue
        if inspect.isbuiltin(value):
            names[name] = _shortened(value, name, _StatedSignature(name), is_method=False)
        elif inspect.isclass(value) and not issubclass(value, BaseException):
            _shorten_methods(value)


def _shorten_methods(kind: type) -> None:
    for name, member in list(vars(kind).items()):
        if not callable(getattr(kind, name)) or (name.startswith("_") and name != "__init__"):
            continue
        shown = kind.__name__ if name == "__init__" else f"{kind.__name__}.{name}"
        is_static = isinstance(member, staticmethod)
        signature = _StatedSignature(f"{kind.__name__}.{name}")
        short = _shortened(getattr(kind, name), shown, signature, is_method=not is_static)
        setattr(kind, name, staticmethod(short) if is_static else short)
