"""skyloop schema: what editors are told of scenario files is what the reader takes and refuses."""
import datetime
import json
import pathlib
import re
import tomllib
import unittest

from session import ROOT, open_folder, skip
from session import skyloop as run_to_end

try:
    import jsonschema
except ImportError:
    skip("python3-jsonschema is absent; apt-get install python3-jsonschema")

# Each is refused by the reader and by the schema.
BROKEN = {
    "an unknown table": "[runn]\nseed = 1\n",
    "an unknown key": "[run]\nsede = 1\n",
    "a text for a number": '[run]\nspeed = "fast"\n',
    "a number for a text": "[[receiver]]\nboard = 8\n",
    "a number below its range": "[run]\nspeed = 0\n",
    "a number above its range": "[sky]\nelevation_mask_deg = 91\n",
    "nothing above zero": "[frame]\norigin = [1, 2, 3]\nreach_m = 0\n",
    "a fraction for a whole number": "[run]\nseed = 1.5\n",
    "a number for true or false": "[sky]\nrebase_navigation = 1\n",
    "a word that is none": '[sky]\nephemeris_rule = "backward"\n',
    "a word that is none in a list": '[sky]\nconstellations = ["gsp"]\n',
    "a word twice in a list": '[sky]\nconstellations = ["gps", "gps"]\n',
    "an empty list of words": "[sky]\nconstellations = []\n",
    "a word for a list": '[[receiver]]\nsentences = "RMC"\n',
    "an empty list of ports": "[[receiver]]\nport = []\n",
    "a table for a list of tables": '[receiver]\nboard = "ublox-m8"\n',
    "a list of tables for a table": "[[run]]\nseed = 1\n",
    "a value for a table": "run = 5\n",
    "too few numbers": "[model.satellite-count]\nsigma_m = [1, 2]\n",
    "too many numbers": "[[receiver]]\nantenna_offset_m = [1, 2, 3, 4]\n",
    "a text among numbers": '[[receiver]]\nantenna_offset_m = [1, 2, "x"]\n',
    "no kind of trajectory": "[trajectory]\nat = [1, 2, 3]\n",
    "an unknown kind of trajectory": '[trajectory]\nkind = "spiral"\n',
    "a kind of a later version": '[trajectory]\nkind = "live"\n',
    "no place": '[trajectory]\nkind = "fixed"\n',
    "two places": '[frame]\norigin = [1, 2, 3]\n[trajectory]\nkind = "fixed"\nat = [1, 2]\nat_level = [1, 2, 3]\n',
    "a key of another kind": '[trajectory]\nkind = "fixed"\nat = [1, 2]\nradius_m = 5\n',
    "a latitude beyond the pole": '[trajectory]\nkind = "fixed"\nat = [91, 2]\n',
    "one waypoint": '[trajectory]\nkind = "waypoints"\nwaypoint = [{ at = [1, 2] }]\n',
    "a waypoint of no place": '[trajectory]\nkind = "waypoints"\nwaypoint = [{ at = [1, 2] }, { hold_s = 1 }]\n',
    "a frame without origin": "[frame]\nunit_m = 1\n",
    "an empty scene": "[scene]\ncache = true\n",
    "a term that is none": "[model.modern.terms.gravity]\nenabled = false\n",
    "a cloud of no kind": "[[atmosphere.cloud]]\nbase_m = 5\n",
    "environment told twice": '[atmosphere]\nenvironment = "city"\nenvironment_noise_db = 3\n',
    "a fault of no kind": "[[fault]]\nat_s = 5\n",
    "an unknown fault": '[[fault]]\nkind = "outtage"\n',
    "a misspelt key of a fault": '[[fault]]\nkind = "outage"\natt_s = 5\n',
    "a key of another fault": '[[fault]]\nkind = "outage"\nppm = 5\n',
    "a fault before the run": '[[fault]]\nkind = "outage"\nat_s = -5\n',
    "a command that lacks its number": '[[command]]\nkind = "set_baud"\n',
    "a length of a command": '[[command]]\nkind = "reboot"\nfor_s = 3\n',
    "a receiver for a command that has none": '[[command]]\nkind = "note"\nreceiver = "receiver0"\n',
    "an expectation of nothing": '[[expect]]\nname = "x"\n',
    "an expectation of two things": '[[expect]]\nwhat = "fix"\ncommand = "true"\n',
    "an exit code of a sentence": '[[expect]]\nwhat = "fix"\nexpect_exit = 0\n',
    "an exit code beyond a byte": '[[expect]]\ncommand = "true"\nexpect_exit = 256\n',
}
# What only the reader can know.
LEFT_TO_CHECK = {
    "an unknown board": '[[receiver]]\nboard = "ublox-m0"\n',
    "a name of nobody": '[[fault]]\nkind = "outage"\nreceiver = "x"\n',
    "a sentence that is none": '[[expect]]\nwhat = "fixx"\n',
    "two times of one beginning": '[[fault]]\nkind = "outage"\nat_s = 5\nat_utc = "2024-03-05T12:00:00Z"\n',
}


def skyloop(*arguments):
    return run_to_end(*arguments, check=False)


def as_json(value):
    """A TOML value as editors hand it to a JSON Schema: dates and times are texts."""
    if isinstance(value, dict):
        return {key: as_json(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [as_json(inner) for inner in value]
    return value.isoformat() if isinstance(value, (datetime.date, datetime.time)) else value


class SchemaTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schema = json.loads(skyloop("schema").stdout)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.validator = jsonschema.Draft7Validator(cls.schema)

    def mistakes(self, text):
        found = self.validator.iter_errors(as_json(tomllib.loads(text)))
        return [f"{'.'.join(map(str, mistake.path))}: {mistake.message[:200]}" for mistake in found]

    def test_it_takes_every_scenario_that_is_here(self):
        files = [file for folder in ("tools/scenarios", "tests", "examples") for file in (ROOT / folder).rglob("*.toml")
                 if file != ROOT / "tests/bench/figures.toml"]
        self.assertGreater(len(files), 40)
        for file in files:
            with self.subTest(file.relative_to(ROOT)):
                self.assertEqual(self.mistakes(file.read_text()), [])

    def test_it_takes_a_scenario_that_has_every_key(self):
        source = (ROOT / "tests/unit/scenario/scenario_text.hpp").read_text()
        texts = re.findall(r'R"toml\((.*?)\)toml"', source, re.DOTALL)
        self.assertGreaterEqual(len(texts), 1)
        for text in texts:
            self.assertEqual(self.mistakes(text), [])

    def test_it_refuses_what_the_reader_refuses(self):
        with open_folder() as folder:
            file = pathlib.Path(folder, "broken.toml")
            for name, text in BROKEN.items():
                with self.subTest(name):
                    file.write_text(text)
                    done = skyloop("check", file)
                    self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
                    self.assertNotEqual(self.mistakes(text), [])

    def test_it_refuses_nothing_that_depends_on_the_whole_file(self):
        for name, text in LEFT_TO_CHECK.items():
            with self.subTest(name):
                self.assertEqual(self.mistakes(text), [])

    def test_every_key_tells_what_it_means(self):
        def look(path, schema):
            for key, inner in schema.get("properties", {}).items():
                with self.subTest(f"{path}.{key}"):
                    self.assertTrue(inner.get("description") or all(one.get("description") for one in inner["anyOf"]))
        look("", self.schema)
        for path, schema in self.schema["definitions"].items():
            look(path, schema)
            self.assertIs(schema["additionalProperties"], False, path)

    def test_defaults_are_taken(self):
        for path, schema in self.schema["definitions"].items():
            for key, inner in schema["properties"].items():
                if "default" in inner:
                    with self.subTest(f"{path}.{key}"):
                        rule = {**inner, "definitions": self.schema["definitions"]}
                        jsonschema.Draft7Validator(rule).validate(inner["default"])


class PageTest(unittest.TestCase):
    def test_the_page_is_what_the_program_tells(self):
        page = (ROOT / "docs/scenario_keys.md").read_text()
        self.assertEqual(skyloop("schema", "--format", "markdown").stdout, page,
                         "docs/scenario_keys.md is old: skyloop schema --format markdown > docs/scenario_keys.md")

    def test_another_format_is_refused(self):
        done = skyloop("schema", "--format", "yaml")
        self.assertEqual(done.returncode, 2)
        self.assertIn("yaml", done.stderr)


if __name__ == "__main__":
    unittest.main()
