# SPDX-License-Identifier: Apache-2.0
"""The package: documentation of every name, types that agree with the module, and the tutorial docs/python.md."""
import ast
import inspect
import os
import pathlib
import pydoc
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import relief

SOURCES = pathlib.Path(__file__).resolve().parents[2]
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def tutorial():
    """The program of the tutorial, with empty lines for its text, so that errors name the line."""
    text = (SOURCES / "docs" / "python.md").read_text(encoding="utf-8")
    lines = [""] * len(text.splitlines())
    for block in BLOCK.finditer(text):
        first = text.count("\n", 0, block.start(1))
        lines[first:first + block[1].count("\n")] = block[1].splitlines()
    return "\n".join(lines) + "\n"


class Package(unittest.TestCase):
    def test_every_public_name_is_documented(self):
        self.assertEqual(sorted(relief.__all__), relief.__all__)
        for name in relief.__all__:
            value = getattr(relief, name)
            if isinstance(value, str):
                continue
            self.assertRegex(inspect.getdoc(value) or "", r"^[A-Z]\S* \S", name)
            if inspect.isclass(value) and value.__module__ == "relief._relief":
                for member, attribute in vars(value).items():
                    if not member.startswith("_"):
                        self.assertTrue(inspect.getdoc(attribute), f"{name}.{member}")

    def test_help_states_types_shapes_and_exceptions(self):
        for name in relief.__all__:
            value = getattr(relief, name)
            if not inspect.isfunction(value) or name in ("set_thread_limit", "run"):
                continue
            with self.subTest(name):
                text = pydoc.plaintext.document(value)
                self.assertNotIn("...)", text.splitlines()[0])
                self.assertNotIn("Ellipsis", text)
                self.assertRegex(text, r"Raises? \w+")
                signature = inspect.signature(value)
                self.assertNotIn(inspect.Parameter.empty, [p.annotation for p in signature.parameters.values()])
                for argument in signature.parameters.values():
                    if "Array" in str(argument.annotation):
                        self.assertRegex(text, rf"\b{argument.name}\b[^.;]*(float32|uint)", argument.name)
        text = pydoc.plaintext.document(relief.Mesh)
        self.assertIn("Mesh(positions: FloatArray, triangles: IntegerArray, *, normals", text)
        self.assertIn("(file: File, *, studio: bool = True", pydoc.plaintext.document(relief.Scene))

    def test_types_name_the_functions_of_the_module(self):
        stub = ast.parse((SOURCES / "python" / "relief" / "_relief.pyi").read_text(encoding="utf-8"))
        stated = {node.name: node for node in stub.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        functions = {name for name in dir(relief._relief) if not name.startswith("__") and name != "tool_directory"}
        self.assertEqual(set(stated), functions)
        for name in ("Execution", "Mesh", "Scene"):
            members = {node.target.id if isinstance(node, ast.AnnAssign) else node.name for node in stated[name].body}
            members = {member for member in members if not member.startswith("_")}
            exported = {member for member in vars(getattr(relief, name)) if not member.startswith("_")}
            self.assertEqual(members, exported)
        # An unknown keyword is refused with the list of those that exist; all of them are stated.
        for name, node in stated.items():
            if not isinstance(node, ast.FunctionDef) or not node.args.kwonlyargs:
                continue
            with self.assertRaises(TypeError) as refused:
                getattr(relief._relief, name)(no_such_option=1)
            shown = re.search(r"\((.*)\) ->", str(refused.exception))[1]
            for argument in [*node.args.args, *node.args.kwonlyargs]:
                self.assertRegex(shown, rf"\b{argument.arg}: ", name)

    def test_types_pass_mypy(self):
        if shutil.which("mypy") is None:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tutorial.py"
            file.write_text(tutorial(), encoding="utf-8")
            wrong = pathlib.Path(folder) / "wrong.py"
            wrong.write_text("import relief\nrelief.vertex_normals(1, 2, weight='heavy')\n", encoding="utf-8")
            environment = {**os.environ, "MYPYPATH": str(pathlib.Path(relief.__file__).parents[1])}
            mypy = ["mypy", "--strict", f"--cache-dir={folder}/cache"]
            done = subprocess.run([*mypy, str(file)], env=environment,
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            done = subprocess.run([*mypy, "-p", "relief"], env=environment, capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            done = subprocess.run([*mypy, str(wrong)], env=environment, capture_output=True, text=True, check=False)
            self.assertEqual(done.stdout.count("error:"), 3, done.stdout)


class Tutorial(unittest.TestCase):
    def test_every_block_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "data").symlink_to(SOURCES / "data")
            (root / "tutorial.py").write_text(tutorial(), encoding="utf-8")
            done = subprocess.run([sys.executable, "tutorial.py"], cwd=root, capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout.splitlines()[0], "(3038, 3) (5760, 3, 4)")
            self.assertIn("expected float32 of shape (n, 3)", done.stdout)
            self.assertIn("float64 copied to float32", done.stdout)
            self.assertRegex(done.stdout, r"\(320, 320, 3\) \[.*'normal map'.*'directional lights'.*\]")
            names = {file.name for file in (root / "out").iterdir()}
            self.assertEqual(names, {"bricks.ktx2", "bricks.png", "urn-unwrapped.ply", "urn.png", "vase-bricks.glb",
                                     "vase-python.png", "vase-python.glb"})
