"""Tables in Markdown, from rows and figures."""
from . import rows

DASH = "–"
MEBIBYTE = 1 << 20


def number(value, digits=4):
    """With so many significant digits, and no more than are needed."""
    if value is None:
        return DASH
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text else text


def fixed(value, places):
    return DASH if value is None else f"{value:.{places}f}"


def table(head, lines):
    """Markdown; nothing for no lines."""
    if not lines:
        return ""
    text = ["| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in [head, *lines]]
    text.insert(1, "|" + "---|" * len(head))
    return "\n".join(text) + "\n"


def pivot(rows_of_suite, place, cell, corner, without="", label=str):
    """One line per technique, one column per place; a dash for what was not measured."""
    places = rows.distinct(place(row) for row in rows_of_suite)
    lines = []
    for technique in rows.distinct(rows.name(row, without) for row in rows_of_suite):
        cells = {place(row): cell(row) for row in rows_of_suite if rows.name(row, without) == technique}
        if any(text != DASH for text in cells.values()):
            lines.append([technique] + [cells.get(at, DASH) for at in places])
    return table([corner] + [label(at) for at in places], lines)


def total(row):
    return row["time_ms"]["total"]


def without_build(row):
    return None if total(row) is None else total(row) - (row["time_ms"]["build"] or 0)


def time_and_error(time):
    """A cell "12.3 ms, 0.0123"."""
    def cell(row):
        error = None if row["technique"] == "copy" else row["error"]["mae"]
        if time(row) is None and error is None:
            return DASH
        parts = [] if time(row) is None else [number(time(row), 3) + " ms"]
        return ", ".join(parts + ([] if error is None else [fixed(error, 4)]))
    return cell


def spread(row):
    time = row["time_ms"]
    if time["total"] is None:
        return DASH
    if time["runs"] < 2:
        return fixed(time["total"], 2) + " (one run)"
    return f"{time['total']:.2f} ({time['total_low']:.2f} to {time['total_high']:.2f})"


def mebibytes(row):
    parts = [row["memory_bytes"]["persistent"], row["memory_bytes"]["transient"]]
    return DASH if None in parts else " + ".join(fixed(part / MEBIBYTE, 1) for part in parts)


def pareto(case_rows):
    """Every row of a case."""
    lines = []
    for row in case_rows:
        time, counts, error = row["time_ms"], row["counts"], row["error"]
        copy = row["technique"] == "copy"
        lines.append([rows.name(row)] +
                     [DASH if copy else fixed(error[key], places)
                      for key, places in (("mae", 4), ("rmse", 4), ("p99", 3))] +
                     [fixed(time[key], 2) for key in ("build", "classify", "evaluate")] +
                     [spread(row), fixed(counts["active"], 0), fixed(counts["primitives_per_active"], 0), mebibytes(row),
                      "front" if row.get("front") else ""])
    return table(["technique", "error", "rms", "99 %", "build ms", "classify ms", "evaluate ms", "total ms (quartiles)",
                  "active", "primitives", "memory MiB", ""], lines)


# Points that the library is held against: how their figures start, and which row it is.
MARKS = [("pcss", {}), ("fitted_pcss", {"near": "fit"})]


def marks(device, case_rows):
    """PCSS's points and Embree's, and the library against them."""
    label = rows.case(case_rows[0])

    def figure(name):
        return device.figure(name, label)

    def ours(name, unit, ratio_name):
        value, about = figure(name)
        if value is None:
            return [DASH, DASH, about]
        return [number(value, 3) + unit, number(figure(ratio_name)[0], 3), rows.name_of_words(about)]

    lines = []
    for key, settings in MARKS:
        error, time = figure(f"{key}_error")[0], figure(f"{key}_ms")[0]
        if error is None:
            continue
        name = rows.technique_name("pcss", settings)
        lines.append([f"**{name}**: error", number(error, 3), "1", ""])
        lines.append([f"**{name}**: time", number(time, 3) + " ms", "1", ""])
        for words, within in (("its time", f"{key}_time"), ("3 times its time", f"3_{key}_times")):
            within = "best_error_within_" + within
            lines.append([f"least error of the library within {words}"] + ours(within, "", f"{within}_over_{key}_error"))
        for words, part in (("its error", ""), ("a third of its error", "_over_3"), ("a quarter of its error", "_over_4")):
            lines.append([f"least time of the library for {words}"] +
                         ours(f"least_ms_for_{key}_error{part}", " ms", f"least_time_for_{key}_error{part}_over_{key}_time"))
    embree = [row for row in case_rows if row["technique"] == "embree" and row["error"]["mae"] is not None]
    for row in embree:
        lines.append([f"**{rows.name(row)}**: error", number(row["error"]["mae"], 3), "", ""])
        lines.append([f"**{rows.name(row)}**: time", number(total(row), 3) + " ms", "", ""])
        for entry in device.figures:
            if entry["name"] != "embree_time_over_ours_at_its_error" or entry["case"] != label:
                continue
            words, _, against = (entry["about"] or "").partition(" against ")
            if rows.name_of_words(words.split(":")[0]) == rows.name(row):
                lines.append(["its time over the library's least for its error", number(entry["value"], 3), "",
                              rows.name_of_words(against) if against else words.partition(": ")[2]])
    return table(["", "figure", "ratio", "by"], lines)


def overall(device):
    lines = [[rows.name(row), fixed(row["measures"]["mean_error"], 4), number(row["measures"]["time_over_pcss"], 3),
              "front" if row.get("front") else ""]
             for row in device.of("pareto") if "mean_error" in row.get("measures", {})]
    return table(["technique", "mean error", "time over PCSS's", ""], lines)


def growth(device):
    names = {"growth_of_time_with_light_width": "time",
             "growth_of_time_per_active_pixel_with_light_width": "time per active pixel",
             "growth_of_primitives_per_active_pixel_with_light_width": "primitives per active pixel"}
    figures = [figure for figure in device.figures if figure["name"] in names]
    cases = rows.distinct(figure["case"] for figure in figures)
    head = ["technique"] + [f"{case}: {what}" for case in cases for what in names.values()]
    lines = []
    for technique in rows.distinct(figure["about"] for figure in figures):
        values = {(figure["case"], figure["name"]): figure["value"] for figure in figures if figure["about"] == technique}
        lines.append([rows.name_of_words(technique)] +
                     [fixed(values.get((case, key)), 2) for case in cases for key in names])
    return table(head, lines)


def packets(device):
    """Times of packets over single pixels', and what the cost model's constants were fitted to."""
    lines = [[figure["about"].split(",")[0].removeprefix("packet="), fixed(figure["value"], 2)]
             for figure in device.figures if figure["name"] == "time_of_packets_over_single_pixels"]
    costs = {figure["name"]: fixed(figure["value"], 1) for figure in device.figures
             if figure["name"].startswith("packet_cost_")}
    fitted = (f"Fitted to counts: {costs['packet_cost_node']} ns for a sample or block looked at, "
              f"{costs['packet_cost_edge']} for an edge found, {costs['packet_cost_projection']} for one projected, of the whole "
              "device." if costs else "")
    by_cost = [figure for figure in device.figures if figure["name"] == "time_by_cost_of_projections"]
    for sparse, what in (("off", "4 x 4 pixels"), ("on", "every second of them")):
        times = [f"{fixed(figure['value'], 2)} at {figure['about'].split(',')[0]}" for figure in by_cost
                 if figure["about"].endswith(f"sparse={sparse}")]
        if times:
            fitted += f" Packets of {what}, by what equation 6 takes a projection to cost: {', '.join(times)}."
    return table(["packet", "time over single pixels'"], lines) + ("\n\n" + fitted if lines and fitted else "")


def skip(device):
    """Times over the copy pass's: without the build, and with it where there is one."""
    values = {}
    for figure in device.figures:
        if figure["name"] in ("time_over_copy", "visibility_time_over_copy"):
            technique = figure["about"].removesuffix(", with the build")
            values[figure["case"], technique, figure["name"]] = figure["value"]

    def cell(variant, technique):
        without = values.get((variant, technique, "visibility_time_over_copy"))
        with_it = values.get((variant, technique, "time_over_copy"))
        built = with_it is not None and without is not None and with_it > 1.001 * without
        return number(without, 3) + (f" ({number(with_it, 3)} with the build)" if built else "")

    techniques = rows.distinct(key[1] for key in values)
    return table(["scene"] + [rows.name_of_words(technique) for technique in techniques],
                 [[variant] + [cell(variant, technique) for technique in techniques]
                  for variant in rows.distinct(key[0] for key in values)])


def motion(device):
    keys = ("changing_pixels", "mean_largest_jump", "p99_largest_jump", "largest_jump", "mean_travel_to_and_fro")
    lines = [[rows.case(row), rows.name(row)] + [number(row["measures"].get(key), 3) for key in keys]
             for row in device.of("stability") if "changing_pixels" in row.get("measures", {})]
    return table(["scene", "technique", "pixels that change", "mean of their largest jumps", "99 %", "largest",
                  "mean of what goes to and fro"], lines)


def acne(device):
    planes = [row for row in device.of("stability")
              if "degrees" in row.get("measures", {}) and row["technique"] != "copy"]

    def cell(row):
        measures = row["measures"]
        if "mean_acne" not in measures:
            return DASH
        return f"{number(measures['mean_acne'], 2)} ({number(measures['largest_acne'], 2)})"
    return pivot(planes, lambda row: row["measures"]["degrees"], cell, "technique", label=lambda at: f"{at:g}°")


def build(device):
    """Time and memory of the hierarchies; ratios are over HSM's."""
    lines = []
    built = device.of("build")
    for case, size in rows.distinct((row["case"], row["map_size"]) for row in built):
        of_size = {row["settings"].get("accel", "auto"): row for row in built
                   if (row["case"], row["map_size"]) == (case, size)}
        base = of_size.get("hsm")
        for accel, row in of_size.items():
            time, memory = row["time_ms"]["build"], row["memory_bytes"]["persistent"]
            ratio = time / base["time_ms"]["build"] if base and time and base["time_ms"]["build"] else None
            lines.append([f"{size}²" if len(rows.distinct(r["case"] for r in built)) == 1 else f"{case}, {size}²",
                          accel.upper(), fixed(time, 2), number(ratio, 3),
                          DASH if memory is None else fixed(memory / MEBIBYTE, 2)])
    return table(["map", "structure", "build ms", "over HSM's", "memory of the light, MiB"], lines)


def order(device):
    """Errors of what the papers compare."""
    compared = [row for row in device.of("seeds") if (row.get("variant") or "").startswith("S4")]
    return pivot(compared, lambda row: row["case"], lambda row: fixed(row["error"]["mae"], 4), "technique")


def claims(device):
    lines = []
    for claim in device.claims:
        verdict = {True: "yes", False: "no", None: "not tried"}[claim["reproduced"]]
        # Lists of figures end in their separator.
        measured = (claim["measured"] or "").rstrip(" ,;")
        lines.append([claim["id"], claim["claim"] or "", measured or DASH, verdict, claim["why"] or ""])
    return table(["", "claim", "measured", "holds", "remark"], lines)


# What the README shows of the first device's cases; those that were not run are left out.
SHORT = [("hard", {}), ("pcf", {}), ("pcss", {}), ("pcss", {"near": "fit"}), ("march", {"samples": "16"}),
         ("march", {"samples": "16", "near": "fit"}), ("average", {"samples": "64"}), ("embree", {"samples": "16"}),
         ("embree", {"samples": "64"}), ("area", {"layers": "1", "primitive": "micropatch"}),
         ("bitmask", {"layers": "1", "primitive": "micropatch", "budget": "8"}),
         ("bitmask", {"layers": "1", "primitive": "micropatch", "budget": "16"}),
         ("bitmask", {"layers": "1", "primitive": "microquad", "budget": "16"}),
         ("contour", {"layers": "1", "budget": "16"}), ("contour", {"layers": "1", "budget": "16", "sparse": "on"}),
         ("bitmask", {"layers": "1", "primitive": "micropatch"}), ("auto", {"layers": "1"}), ("auto", {})]


def short(device):
    cases = [case_rows for case_rows in rows.pareto_cases(device)]
    # The same scene again, only larger, would make the table too wide.
    first = {case_rows[0]["case"]: case_rows for case_rows in reversed(cases)}
    cases = [case_rows for case_rows in cases if first[case_rows[0]["case"]] is case_rows]
    lines = []
    for technique, settings in SHORT:
        line = []
        for case_rows in cases:
            row = next((row for row in case_rows if rows.is_technique(row, technique, **settings)), None)
            if row is None:
                line += [DASH, DASH]
                continue
            built = row["time_ms"]["build"]
            line += [fixed(row["error"]["mae"], 3),
                     fixed(without_build(row), 1) + (f" + {built:.1f}" if built else "")]
        if any(cell != DASH for cell in line):
            lines.append([rows.technique_name(technique, settings)] + line)
    head = [text for case_rows in cases for text in (f"{case_rows[0]['case']}: error", "ms + build")]
    return table(["technique"] + head, lines)
