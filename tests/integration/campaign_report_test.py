#!/usr/bin/env python3
"""The page of a campaign, read by a parser of XML and one of HTML that know nothing of it."""
import html.parser
import json
import os
import pathlib
import re
import shlex
import statistics
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

import campaign_database
from session import SKYLOOP, skyloop

SVG = "{http://www.w3.org/2000/svg}"
VOID = {"meta", "br", "img", "input", "link", "hr"}


class Page(html.parser.HTMLParser):
    """What a browser sees: elements with their attributes, text, and whether each element is closed."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.text = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()

    def handle_data(self, data):
        self.text.append(data)


def write_report(folder, *options):
    return skyloop("campaign", "report", folder, *options).stdout


def percentile(values, share):
    """Linear between order statistics."""
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


class CampaignReport(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="skyloop-report-")
        cls.place = pathlib.Path(cls.folder.name)
        cls.runs = campaign_database.drawn_runs(1200)[:1190]
        campaign_database.write(cls.place / "campaign.sqlite", cls.runs, planned=1200)
        cls.text = write_report(cls.place)
        cls.html = (cls.place / "report.html").read_text()
        cls.json = json.loads((cls.place / "report.json").read_text())
        cls.ended = [run for run in cls.runs if run["status"] != "error"]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_needs_nothing_else(self):
        page = Page(self.html)
        self.assertEqual(page.open, [])
        for tag, attributes in page.elements:
            self.assertNotIn(tag, {"script", "link", "img", "iframe", "object", "embed", "image", "use"})
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), name)
                self.assertNotIn(name, {"src", "href", "xlink:href", "srcset"})
                self.assertNotIn("url(", value or "")
        self.assertNotIn("url(", self.html)
        self.assertNotIn("@import", self.html)
        self.assertIn("prefers-color-scheme: dark", self.html)
        addresses = set(re.findall(r"https?://[^\"' <]+", self.html))
        self.assertEqual(addresses, {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"})

    def test_it_is_xml_and_each_picture_has_a_name(self):
        root = ElementTree.fromstring(self.html.split("\n", 1)[1])
        pictures = root.findall(f".//{SVG}svg")
        self.assertGreater(len(pictures), 20)
        for picture in pictures:
            self.assertTrue(picture.find(f"{SVG}title").text)
            for element in picture.iter():
                for name, value in element.attrib.items():
                    self.assertNotRegex(value, r"\b(nan|inf)\b", name)

    def test_counts_are_those_of_the_runs(self):
        self.assertEqual(self.json["runs"]["planned"], 1200)
        self.assertEqual(self.json["runs"]["missing"], 10)
        for status in ("passed", "failed"):
            self.assertEqual(self.json["runs"][status], sum(run["status"] == status for run in self.runs))
        self.assertEqual(self.json["runs"]["errors"], sum(run["status"] == "error" for run in self.runs))
        self.assertEqual(len(self.json["failed_runs"]), sum(run["status"] != "passed" for run in self.runs))
        for verdict in self.json["verdicts"]:
            outcomes = [run["verdicts"][verdict["name"]][0] for run in self.ended]
            self.assertEqual(verdict["rate"]["passed"], sum(outcomes))
            self.assertEqual(verdict["rate"]["trials"], len(outcomes))
            levels = [p for p in verdict["by_parameter"] if p["parameter"] == "receiver.mask_deg"][0]["levels"]
            self.assertEqual([level["label"] for level in levels], ["5", "10", "15", "20", "25"])
            for level in levels:
                of_level = [run["verdicts"][verdict["name"]][0] for run in self.ended
                            if run["parameters"]["receiver.mask_deg"] == level["label"]]
                self.assertEqual(level["rate"]["passed"], sum(of_level))

    def test_figures_are_those_of_the_statistics_module(self):
        self.assertEqual([metric["name"] for metric in self.json["metrics"]], list(self.ended[0]["metrics"]))
        for metric in self.json["metrics"]:
            values = [run["metrics"][metric["name"]] for run in self.ended]
            values = [value for value in values if value is not None]
            self.assertEqual(metric["count"], len(values))
            self.assertEqual(metric["without"], len(self.ended) - len(values))
            self.assertAlmostEqual(metric["mean"], statistics.fmean(values), places=9)
            self.assertAlmostEqual(metric["sd"], statistics.stdev(values), places=9)
            self.assertEqual((metric["min"], metric["max"]), (min(values), max(values)))
            for told in metric["percentiles"]:
                self.assertAlmostEqual(told["value"], percentile(values, told["share"]), places=9)
                low, high = told["interval"]
                self.assertLessEqual(low, told["value"])
                self.assertLessEqual(told["value"], high)
                self.assertIn(low, values)

    def test_it_sees_what_was_put_in(self):
        metric = {metric["name"]: metric for metric in self.json["metrics"]}
        effects = {effect["parameter"]: effect for effect in metric["horizontal_error_p95_m"]["effects"]}
        self.assertGreater(effects["noise.code_m"]["spearman"]["rho"], 0.4)
        self.assertTrue(effects["receiver.mask_deg"]["seen"])
        self.assertTrue(effects["receiver.model"]["seen"])
        self.assertNotIn("spearman", effects["receiver.model"])
        effects = {effect["parameter"]: effect for effect in metric["satellites_mean"]["effects"]}
        self.assertLess(effects["receiver.mask_deg"]["spearman"]["rho"], -0.7)
        self.assertFalse(effects["noise.code_m"]["seen"])
        self.assertIn("falls strongly with receiver.mask_deg", self.text)

    def test_worst_runs_come_with_commands_a_shell_takes(self):
        metric = self.json["metrics"][0]
        values = sorted((run["metrics"][metric["name"]] for run in self.ended), reverse=True)
        self.assertEqual([run["value"] for run in metric["worst"]], values[:10])
        page = "".join(Page(self.html).text)
        for run in metric["worst"]:
            self.assertEqual(shlex.split(run["replay"]), ["skyloop", "campaign", "replay", "canyon.toml", "--number",
                                                          str(run["number"]), "--out", f"run-{run['number']}"])
            self.assertIn(run["replay"], page)

    def test_the_same_database_gives_the_same_bytes_anywhere(self):
        with tempfile.TemporaryDirectory(prefix="elsewhere-") as folder:
            other = pathlib.Path(folder)
            (other / "campaign.sqlite").write_bytes((self.place / "campaign.sqlite").read_bytes())
            environment = dict(os.environ, LC_ALL="de_DE.UTF-8", TZ="Asia/Tokyo")
            subprocess.run([SKYLOOP, "campaign", "report", folder], check=True, stdout=subprocess.DEVNULL, env=environment, timeout=60)
            self.assertEqual((other / "report.html").read_text(), self.html)
            self.assertEqual((other / "report.json").read_bytes(), (self.place / "report.json").read_bytes())

    def test_options_of_the_command(self):
        with tempfile.TemporaryDirectory(prefix="skyloop-report-") as folder:
            page = pathlib.Path(folder) / "page.html"
            write_report(self.place, "--out", page, "--worst", "3")
            self.assertEqual(len(json.loads(page.with_suffix(".json").read_text())["metrics"][0]["worst"]), 3)
            self.assertTrue(page.read_text().startswith("<!DOCTYPE html>"))
            for wrong, code, words in ((["--worst", "-1"], 2, "--worst"), (["--out", "page.json"], 2, "does not end in .json")):
                done = skyloop("campaign", "report", self.place, *wrong, check=False)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(words, done.stderr)
            done = skyloop("campaign", "report", folder, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn("no such file; 'skyloop campaign gather' makes it", done.stderr)
            (pathlib.Path(folder) / "campaign.sqlite").write_text("no database at all")
            done = skyloop("campaign", "report", folder, check=False)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (2, 1))

    def test_ten_thousand_runs_stay_a_page(self):
        with tempfile.TemporaryDirectory(prefix="skyloop-report-") as folder:
            place = pathlib.Path(folder)
            campaign_database.write(place / "campaign.sqlite", campaign_database.drawn_runs(10000))
            begin = time.monotonic()
            write_report(place)
            print(f"10000 runs: {time.monotonic() - begin:.2f} s, {(place / 'report.html').stat().st_size} bytes")
            self.assertLess((place / "report.html").stat().st_size, 3_000_000)
            # What is left out of a picture is told in it.
            self.assertRegex((place / "report.html").read_text(), r"drawn at 500 of its \d+ steps")
            self.assertRegex((place / "report.html").read_text(), r">\d+ of \d+ runs drawn")

    def test_a_quoted_scenario_and_evil_texts_stay_texts(self):
        runs = campaign_database.drawn_runs(40)
        for run in runs:
            run["parameters"]["<b>&'\"x"] = "</td><script>alert(1)</script>"
            if run["status"] != "error":
                run["verdicts"]["]]><svg onload=alert(1)>"] = (False, "<!-- " * 5)
                run["status"] = "failed"
        with tempfile.TemporaryDirectory(prefix="skyloop-report-") as folder:
            place = pathlib.Path(folder)
            campaign_database.write(place / "campaign.sqlite", runs, name="</title><script>", scenario="it's $(x).toml")
            write_report(place)
            text = (place / "report.html").read_text()
            page = Page(text)
            self.assertNotIn("script", {tag for tag, _ in page.elements})
            self.assertNotIn("b onload", text)
            self.assertFalse(any("onload" in attributes for _, attributes in page.elements))
            ElementTree.fromstring(text.split("\n", 1)[1])
            command = json.loads((place / "report.json").read_text())["failed_runs"][0]["replay"]
            self.assertEqual(shlex.split(command)[3], "it's $(x).toml")


if __name__ == "__main__":
    unittest.main()
