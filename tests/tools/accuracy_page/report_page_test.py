#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the page of sample_report.json in a headless browser: report_page_test.py PAGE.

Exits with 77 without a browser (Debian's chromium and chromium-driver). Run by
report_page_test.cpp, which makes the page.
"""
import json
import pathlib
import sys
import unittest

import browser

PAGE = None
REPORT = json.loads((pathlib.Path(__file__).parent / "sample_report.json").read_text())
ARTICLE = "#normals\\/sample "


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def setUp(self):
        self.browser.resize(1280, 900)
        self.browser.log("performance")
        self.browser.log("browser")
        self.browser.open(PAGE)

    def tearDown(self):
        self.assertEqual(self.browser.log("browser"), [], "the console has messages")

    def count(self, selector):
        return self.browser.run("return document.querySelectorAll(arguments[0]).length", selector)

    def click(self, selector, index=0):
        self.browser.run("document.querySelectorAll(arguments[0])[arguments[1]].click()", selector, index)

    def test_requests_only_itself(self):
        requests = [address for address in self.browser.requests() if not address.startswith("data:")]
        self.assertEqual(requests, [PAGE.resolve().as_uri()])

    def test_plots_and_tables_have_all_measurements(self):
        for experiment in REPORT["experiments"]:
            article = f'article[id="{experiment["id"]}"] '
            count = len(experiment["measurements"])
            self.assertEqual(self.count(article + ".scatter .point > title"), count)
            self.assertEqual(self.count(article + ".measurements tbody tr"), count)
        self.assertEqual(self.count("img"), 3)
        self.assertTrue(self.browser.run(
            "return [...document.images].every((picture) => picture.naturalWidth === 64)"))

    def test_filters_hide_points_and_rows(self):
        self.click(ARTICLE + ".scatter .choice input")  # weighting: area
        self.assertEqual(self.count(ARTICLE + ".scatter .point:not(.hidden)"), 4)
        self.assertEqual(self.count(ARTICLE + ".measurements tbody tr:not(.hidden)"), 4)
        self.click(ARTICLE + ".scatter .choice input")
        self.assertEqual(self.count(ARTICLE + ".scatter .point:not(.hidden)"), 6)
        self.click(ARTICLE + ".chart .choice input")  # One of two curves with four points each.
        self.assertEqual(self.count(ARTICLE + ".chart .point:not(.hidden)"), 12)
        self.assertEqual(self.count(ARTICLE + ".chart .fit:not(.hidden)"), 1)
        self.assertEqual(self.count(".measurements tbody tr.hidden"), 0)

    def test_tables_are_sorted_by_a_column(self):
        order = """return [...document.querySelectorAll(arguments[0])].map((row) => Number(row.dataset.index))"""
        rows = ARTICLE + ".measurements tbody tr"
        self.click(ARTICLE + ".measurements thead button", 1)  # RMS
        self.assertEqual(self.browser.run(order, rows), [4, 3, 2, 0, 1, 5], "no number comes last")
        self.click(ARTICLE + ".measurements thead button", 1)
        self.assertEqual(self.browser.run(order, rows), [0, 1, 2, 3, 4, 5])
        self.assertEqual(self.count('th[aria-sort="descending"]'), 1)

    def test_the_fitted_line_lies_on_its_points(self):
        gap = self.browser.run("""
            const [line, ...points] = document.querySelectorAll('.chart svg [data-index="0"]:is(.fit, .point)');
            const at = points[0].getAttribute('transform').match(/[\\d.]+/g).map(Number);
            return [line.x1.baseVal.value - at[0], line.y1.baseVal.value - at[1]]""")
        self.assertLess(max(map(abs, gap)), 0.11)  # Coordinates have one decimal.

    def test_a_phone_does_not_scroll_sideways(self):
        self.browser.resize(320, 844, is_phone=True)
        self.browser.open(PAGE)
        widths = self.browser.run("return [document.documentElement.scrollWidth, innerWidth]")
        self.assertEqual(widths, [320, 320])


if __name__ == "__main__":
    if browser.programs() is None:
        print("needs a browser: Debian's chromium and chromium-driver", file=sys.stderr)
        sys.exit(77)
    PAGE = pathlib.Path(sys.argv.pop(1))
    unittest.main()
