"""What softshadow-bench wrote: devices, rows, and how techniques are called."""
import json
import re


class Unusable(Exception):
    """A JSON file that is none of softshadow-bench's."""


class Device:
    """All that was measured on one device with one driver."""

    def __init__(self, name, driver):
        self.name = name
        self.driver = driver
        self.folder_name = re.sub(r"[^a-z0-9]+", "-", name.split("(")[0].lower()).strip("-") or "device"
        self.rows, self.figures, self.claims = [], [], []
        self.folders = []  # beside the JSON files
        self.quick = False
        self.complete = True

    def of(self, suite):
        return [row for row in self.rows if row.get("suite") == suite]

    def figure(self, name, case):
        """The value and what it is made of; (None, "") for what was not measured."""
        for figure in self.figures:
            if figure["name"] == name and figure["case"] == case:
                return figure["value"], figure["about"] or ""
        return None, ""


def load(paths):
    devices = {}
    for path in paths:
        try:
            report = json.loads(path.read_text())
            first = report["rows"][0]
            key = first["device"], first["driver"]
            device = devices.setdefault(key, Device(*key))
            for part in ("rows", "figures", "claims"):
                getattr(device, part).extend(report[part])
            device.quick = device.quick or report["quick"]
            device.complete = device.complete and report["complete"]
        except (ValueError, KeyError, TypeError) as error:
            raise Unusable(f"{path}: not of softshadow-bench --json: {error}") from error
        except IndexError:
            raise Unusable(f"{path}: has no rows") from None
        if path.parent not in device.folders:
            device.folders.append(path.parent)
    return list(devices.values())


def distinct(values):
    return list(dict.fromkeys(values))


TITLES = {"pcf": "PCF", "pcss": "PCSS", "embree": "Embree"}
PRIMITIVES = {"micropatch": "micropatches", "micropatch-unextended": "unextended micropatches",
              "microquad": "microquads", "microquad-rectangle": "rectangles"}


def setting_words(key, value):
    if key == "primitive":
        return PRIMITIVES.get(value, value)
    if key == "accel":
        return value.upper()
    if key == "budget" and value == "inf":
        return "no budget"
    if key == "layers":
        return f"{value} layer{'s' if value != '1' else ''}"
    if key in ("samples", "steps", "taps"):
        return f"{value} {key}"
    if key == "blockers":
        return f"{value} blocker taps"
    return f"{key} {value}"


def technique_name(technique, settings, without=""):
    """As in the plots (bench/plots/names.cpp): what is computed comes before how much of it."""
    keys = sorted(settings, key=lambda key: (key != "primitive", key))
    return ", ".join([TITLES.get(technique, technique)] +
                     [setting_words(key, settings[key]) for key in keys if key != without])


def name(row, without=""):
    return technique_name(row["technique"], row["settings"], without)


def name_of_words(words):
    """Of "bitmask budget=16 primitive=micropatch", as figures have it."""
    technique, *settings = words.split() or [""]
    if not all("=" in setting for setting in settings):
        return words
    return technique_name(technique, dict(setting.split("=", 1) for setting in settings))


def case(row):
    """As figures call it."""
    return f"{row['case']} {row['width']}x{row['height']}"


def is_technique(row, technique, **settings):
    return row["technique"] == technique and row["settings"] == settings


def plain(text):
    """As in the names of plots."""
    return re.sub(r"[^A-Za-z0-9._-]", "_", text)


def pareto_cases(device):
    """Lists of rows, one per case and size."""
    rows = [row for row in device.of("pareto") if row["case"] != "all cases"]
    return [[row for row in rows if case(row) == label] for label in distinct(map(case, rows))]
