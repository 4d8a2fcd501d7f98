#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of the Python module as a GoogleTest program does, for scripts/dev/run-tests.

It understands --gtest_list_tests, --gtest_filter, --gtest_output=xml:FILE and --gtest_flagfile=FILE. A case is
"Class.test_name". Without the module, all cases are skipped.
"""
import fnmatch
import importlib
import pathlib
import sys
import time
import traceback
import types
import unittest
import xml.etree.ElementTree as tree

FOLDER = pathlib.Path(__file__).resolve().parent


def name_of(test):
    return f"{type(test).__name__}.{test._testMethodName}"


def cases_of(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from cases_of(test)
        else:
            yield test


class Result(unittest.TestResult):
    """Prints GoogleTest's lines, and keeps (name, seconds, status, text) of each case."""

    def __init__(self):
        super().__init__()
        self.entries = []

    def startTest(self, test):
        super().startTest(test)
        self.begin, self.status, self.text = time.monotonic(), "passed", ""
        print(f"[ RUN      ] {name_of(test)}", flush=True)

    def fail(self, error):
        self.status = "failed"
        self.text += "".join(traceback.format_exception(*error))

    def addFailure(self, test, error):
        super().addFailure(test, error)
        self.fail(error)

    def addError(self, test, error):
        super().addError(test, error)
        self.begin = getattr(self, "begin", time.monotonic())
        if isinstance(test, unittest.TestCase):
            self.fail(error)
        else:  # setUpClass: its cases do not run, which scripts/dev/run-tests reports.
            traceback.print_exception(*error, file=sys.stdout)

    def addSubTest(self, test, subtest, error):
        super().addSubTest(test, subtest, error)
        if error is not None:
            self.text += f"{subtest.id()}\n"
            self.fail(error)

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self.status, self.text = "skipped", reason

    def stopTest(self, test):
        super().stopTest(test)
        seconds = time.monotonic() - self.begin
        word = {"passed": "      OK", "failed": " FAILED ", "skipped": " SKIPPED"}[self.status]
        if self.text:
            print(self.text)
        print(f"[ {word} ] {name_of(test)} ({int(1000 * seconds)} ms)", flush=True)
        self.entries.append((name_of(test), seconds, self.status, self.text))


def write_xml(file, entries):
    root = tree.Element("testsuites")
    suites = {}
    for name, seconds, status, text in entries:
        suite, case = name.split(".")
        if suite not in suites:
            suites[suite] = tree.SubElement(root, "testsuite", name=suite)
        element = tree.SubElement(suites[suite], "testcase", name=case, classname=suite, time=f"{seconds:.3f}",
                                  status="run", result="skipped" if status == "skipped" else "completed")
        if status == "failed":
            tree.SubElement(element, "failure").text = text
        elif status == "skipped":
            tree.SubElement(element, "skipped", message=text)
    tree.ElementTree(root).write(file, encoding="utf-8", xml_declaration=True)


def flags_of(arguments):
    flags = {}
    for argument in arguments:
        name, _, value = argument.partition("=")
        if name == "--gtest_flagfile":
            flags.update(flags_of(pathlib.Path(value).read_text(encoding="utf-8").splitlines()))
        else:
            flags[name] = value
    return flags


def main():
    flags = flags_of(sys.argv[1:])
    sys.path.insert(0, str(FOLDER))
    reason = ""
    try:
        importlib.import_module("relief")
    except ImportError as error:
        reason = f"The Python module is not built: {error}"
        for name in ("numpy", "relief"):  # The test files import both.
            sys.modules.setdefault(name, types.ModuleType(name))
    loaded = unittest.defaultTestLoader.loadTestsFromNames(sorted(file.stem for file in FOLDER.glob("test_*.py")))
    patterns = flags.get("--gtest_filter", "*").split(":")
    cases = [case for case in cases_of(loaded)
             if any(fnmatch.fnmatchcase(name_of(case), pattern) for pattern in patterns)]
    output = flags.get("--gtest_output", "").removeprefix("xml:")
    if "--gtest_list_tests" in flags:
        print("\n".join(name_of(case) for case in cases))
        entries = [(name_of(case), 0.0, "passed", "") for case in cases]
        ok = True
    else:
        if reason:
            for case in cases:
                setattr(type(case), "__unittest_skip__", True)
                setattr(type(case), "__unittest_skip_why__", reason)
        result = Result()
        unittest.TestSuite(loaded_in_order(cases)).run(result)
        entries, ok = result.entries, result.wasSuccessful()
    if output:
        write_xml(output, entries)
    return 0 if ok else 1


def loaded_in_order(cases):
    """Keeps the cases of a class together, so that they share its fixture."""
    return sorted(cases, key=lambda case: type(case).__name__)


if __name__ == "__main__":
    sys.exit(main())
