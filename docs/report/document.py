"""docs/benchmarks.md and the table of README.md."""
import string

from . import pictures, rows, tables

NOTE = "<!-- Written by docs/benchmarks.py: change docs/report instead. -->\n\n"


class Template(string.Template):
    delimiter = "@"


def sections(*parts):
    """What is empty leaves no gap."""
    return "\n".join(part.rstrip("\n") + "\n" for part in parts if part)


def conditions(device):
    suites = rows.distinct(row.get("suite") for row in device.rows)
    text = f"{device.name}, {device.driver}; suites {', '.join(filter(None, suites))}."
    if device.quick:
        text += " A `--quick` run: small pictures and maps, few rays, few repetitions."
    if not device.complete:
        text += " The run was interrupted: rows are missing."
    return text + "\n"


class Section:
    """Of one device; paths of images are as seen from docs."""

    def __init__(self, device, docs):
        self.device = device
        self.docs = docs

    def image(self, file_name, caption):
        path = f"images/benchmarks/{self.device.folder_name}/{rows.plain(file_name)}"
        if not (self.docs / path).is_file():
            return ""
        short = caption.partition(":")[0].partition(".")[0]
        return f"![{short}]({path})\n\n*{caption.rstrip('.')}.*\n"

    def plots(self, suite, caption):
        cases = rows.distinct(row["case"] for row in self.device.of(suite))
        return sections(*(self.image(f"{suite}-{case}.svg", f"{caption}: {case}.") for case in cases))

    def part(self, title, *contents):
        """A heading and what is under it; nothing where nothing was measured."""
        body = sections(*contents[1:])
        return sections(f"### {title}\n", contents[0], body) if body else ""

    def picture(self, case_rows):
        scene = case_rows[0]["case"]
        chosen = pictures.shown(self.device, case_rows)
        if not chosen:
            return self.image(f"{scene}.png", f"{scene}: truth and techniques, with their errors under them")
        names = "; ".join(rows.name(row) for row in chosen)
        return self.image(f"{scene}.png",
                          f"{scene}, where errors are largest: truth; {names}. Under each its absolute error, black for 0 to "
                          "white for 0.5 and more (the scale is under the truth); grey is not compared.")

    def worst(self):
        found = pictures.worst(self.device)
        if found is None:
            return self.image("worst.png", "Truth, PCSS, and the library where it is worst")
        ratio, row, pcss = found
        return self.image("worst.png",
                          f"The worst of our own against PCSS: {rows.name(row)} on {rows.case(row)}, where its error is "
                          f"{row['error']['mae']:.4f}, {ratio:.2f} times that of {rows.name(pcss)}, enlarged where it is "
                          f"largest. Truth; {rows.name(pcss)}; {rows.name(row)}; errors on the same scale.")

    def pareto(self):
        parts = []
        pictured = list(pictures.shown_cases(self.device))
        for case_rows in rows.pareto_cases(self.device):
            row = case_rows[0]
            label = rows.case(row)
            parts += [f"#### {label}, map {row['map_size']}², light {row['light_size']:.4g} wide\n",
                      self.image(f"pareto-{row['case']}-{row['width']}x{row['height']}.svg",
                                 f"Error over time, {label}. Bars are quartiles; dashed lines meet at PCSS."),
                      tables.marks(self.device, case_rows), tables.pareto(case_rows)]
            if case_rows in pictured:
                parts.append(self.picture(case_rows))
        if tables.overall(self.device):
            parts += ["#### All cases\n", self.image("pareto-all.svg", "Mean error over time relative to PCSS's"),
                      tables.overall(self.device)]
        return self.part("Error against time", "", *parts, self.worst())

    def sweep(self, suite, title, text, time, place, label, without=""):
        parts = []
        of_suite = self.device.of(suite)
        for case in rows.distinct(row["case"] for row in of_suite):
            of_case = [row for row in of_suite if row["case"] == case]
            parts += [self.image(f"{suite}-{case}.svg", f"{title}: {case}"),
                      tables.pivot([row for row in of_case if place(row) is not None], place, tables.time_and_error(time),
                                   case, without, label)]
        if suite == "light-size":
            parts.append(tables.growth(self.device))
        return self.part(title, text, *parts)

    def text(self):
        return sections(
            conditions(self.device),
            self.pareto(),
            self.sweep("light-size", "Size of the light", "Time without the build and error over the light's width in world "
                       "units, then exponents p: what grows as width^p, fitted over the widest lights (a sixteenth of the "
                       "widest and up).", tables.without_build,
                       lambda row: row["light_size"], lambda at: f"{at:.3g}"),
            self.sweep("resolution", "Size of the picture", "Time with the build and error.", tables.total,
                       lambda row: (row["width"], row["height"]), lambda at: f"{at[0]} x {at[1]}"),
            self.sweep("map-size", "Size of the map", "Time with the build and error over the edge of the map in texels.",
                       tables.total, lambda row: row["map_size"], lambda at: f"{at}²"),
            self.sweep("budget", "Budget", "Time with the build and error over the budget.", tables.total,
                       lambda row: row["settings"].get("budget"), str, "budget"),
            self.part("Acceleration structures", "What they cost.",
                      self.plots("build", "Time and memory over the map's size"), tables.build(self.device)),
            self.part("Nothing to do", "Times over that of a pass that reads the depth and writes 1, without the build and "
                      "with it.", self.image("skip.svg", "Time over that of a copy pass"), tables.skip(self.device)),
            self.part("Stability", "The light and its map move by one texel in small steps; changes of visibility from one "
                      "step to the next, over the pixels that change. What goes to and fro would be zero for a shadow that "
                      "only moves.", self.image("stability-motion.svg", "Largest jumps while the light moves"),
                      tables.motion(self.device)),
            self.part("Acne", "A plane tilted against the light: how dark pixels are that see the whole light, mean and "
                      "(largest). A dash: no pixel sees the whole light.",
                      self.image("stability-plane.svg", "Darkening over the angle"), tables.acne(self.device)),
            self.part("Patterns, primitives, layers and the post filter", "Errors; every one without a budget.",
                      tables.order(self.device)),
            self.part("Packets", "Evaluation of contours, mean over the suite's cases and lights.",
                      tables.packets(self.device)),
            self.part("Claims of the papers", "Each held against this run.", tables.claims(self.device)))


def short_table(device, docs):
    text = f"{device.name}, {device.driver}; "
    cases = rows.pareto_cases(device)
    sizes = rows.distinct(f"{case[0]['width']} x {case[0]['height']}" for case in cases)
    text += f"{sizes[0] if sizes else 'no'} pixels" + (", a quick run" if device.quick else "") + ".\n\n"
    text += tables.short(device) or tables.DASH + "\n"
    for case_rows in cases[:1]:
        row = case_rows[0]
        plot = rows.plain(f"pareto-{row['case']}-{row['width']}x{row['height']}.svg")
        path = f"images/benchmarks/{device.folder_name}/{plot}"
        if (docs / path).is_file():
            text += f"\n![error over time, {rows.case(row)}](docs/{path})\n"
    return text


def replace_table(readme, table):
    begin, end = "<!-- table:begin -->\n", "<!-- table:end -->\n"
    before, found, rest = readme.partition(begin)
    _, also_found, after = rest.partition(end)
    if not found or not also_found:
        raise rows.Unusable("README.md has no lines <!-- table:begin --> and <!-- table:end -->")
    return before + begin + table + end + after


def write(devices, root, out):
    docs = out / "docs"
    docs.mkdir(parents=True, exist_ok=True)
    results = "\n".join(f"## Results: {device.name}\n\n" + Section(device, docs).text() for device in devices)
    template = Template((root / "docs/report/benchmarks.in.md").read_text())
    (docs / "benchmarks.md").write_text(NOTE + template.substitute(results=results))
    readme = (root / "README.md").read_text()
    # A run of other suites alone has nothing for it.
    if any(rows.pareto_cases(device) for device in devices[:1]):
        readme = replace_table(readme, short_table(devices[0], docs))
    (out / "README.md").write_text(readme)
