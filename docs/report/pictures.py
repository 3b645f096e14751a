"""The plots and pictures of the report: plots as gnuplot drew them, pictures composed by oiiotool."""
import pathlib
import re
import subprocess
import tempfile

from . import rows

# Beside the truth, as far as there are pictures of them.
SHOWN = [("pcss", {}), ("pcss", {"near": "fit"}), ("march", {"samples": "16", "near": "fit"}),
         ("embree", {"samples": "16"}),
         ("contour", {"layers": "1", "budget": "8"}),
         ("bitmask", {"layers": "1", "primitive": "micropatch", "budget": "16"}), ("auto", {}),
         ("march", {"samples": "16"}), ("area", {"layers": "1", "primitive": "micropatch"}),
         ("average", {"samples": "16"}), ("hard", {}), ("pcf", {})]
COLUMNS = 4
MOST = 2 * COLUMNS - 1  # two rows of pictures, one of which begins with the truth
CELL = (240, 180)       # pixels
BLOCK = 8               # errors are looked for in blocks of so many pixels


def stem(row, what):
    """As softshadow-bench --images calls it."""
    name = f"{row['suite']}-{row['case']}-{row['width']}-{what}"
    return name.replace(" ", "-").replace("/", "-").replace("=", "_")


def file_stem(row):
    return stem(row, "-".join([row["technique"]] + [f"{key}={value}" for key, value in sorted(row["settings"].items())]))


def truth_stem(row):
    return stem(row, "truth")


def picture_of(device, file_name):
    for folder in device.folders:
        if (folder / "images" / f"{file_name}.png").is_file():
            return folder / "images" / f"{file_name}.png"
    return None


def pair(device, row):
    """Picture and heat map of a row, or None."""
    found = picture_of(device, file_stem(row)), picture_of(device, file_stem(row) + "-error")
    return None if None in found else found


def shown(device, case_rows):
    """Rows that a case's picture shows."""
    chosen = []
    for technique, settings in SHOWN:
        chosen += [row for row in case_rows if rows.is_technique(row, technique, **settings) and pair(device, row)]
    chosen = chosen[:MOST]
    return [row for row in case_rows if row in chosen]


def shown_cases(device):
    """One list of rows per scene: larger pictures of one show nothing new."""
    seen = set()
    for case_rows in rows.pareto_cases(device):
        if case_rows[0]["case"] not in seen:
            seen.add(case_rows[0]["case"])
            yield case_rows


def worst(device):
    """Where the library does worst against PCSS, the better of its two near planes: the row of `auto`, or of the best
    within three times PCSS's time, with the largest error over PCSS's, and PCSS's row. None if there is none."""
    found = None
    for case_rows in rows.pareto_cases(device):
        points = [row for row in case_rows if row["technique"] == "pcss" and row["settings"] in ({}, {"near": "fit"})
                  and row["error"]["mae"] and pair(device, row)]
        if not points:
            continue
        pcss = min(points, key=lambda row: row["error"]["mae"])
        best = [rows.name_of_words(device.figure(f"best_error_within_3_{key}_times", rows.case(pcss))[1])
                for key in ("pcss", "fitted_pcss")]
        for row in case_rows:
            if (row["technique"] == "auto" or rows.name(row) in best) and pair(device, row):
                ratio = row["error"]["mae"] / pcss["error"]["mae"]
                if found is None or ratio > found[0]:
                    found = ratio, row, pcss
    return found


def oiiotool(*arguments):
    command = ["oiiotool", *map(str, arguments)]
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except FileNotFoundError:
        raise rows.Unusable("oiiotool is needed for the pictures and was not found") from None
    except subprocess.CalledProcessError as error:
        words = (error.stderr or error.stdout).strip().splitlines()
        raise rows.Unusable(f"oiiotool: {words[0] if words else 'failed'}") from error


def window(heat_maps, size, cell):
    """Left and top of the `cell` with the largest sum of errors. Red grows with the error in heat maps; what is grey there,
    outside the mask, counts as nothing."""
    columns, lines = max(1, size[0] // BLOCK), max(1, size[1] // BLOCK)
    commands = []
    for i, heat_map in enumerate(heat_maps):
        commands += [heat_map, "--ch", "R", "--subc", "0.157", "--clamp:min=0", "-d", "float", "--resize:filter=box",
                     f"{columns}x{lines}"] + (["--add"] if i else [])
    with tempfile.TemporaryDirectory() as folder:
        blocks = pathlib.Path(folder) / "blocks.exr"
        oiiotool(*commands, "-d", "float", "-o", blocks)
        pixels = re.findall(r"Pixel \((\d+), (\d+)\): ([-.e\d]+)", oiiotool("--info", "-v", "--dumpdata", blocks))
    sums = [[0.0] * columns for _ in range(lines)]
    for x, y, value in pixels:
        sums[int(y)][int(x)] = float(value)
    width, height = max(1, min(cell[0] // BLOCK, columns)), max(1, min(cell[1] // BLOCK, lines))
    best = max((sum(sum(line[x:x + width]) for line in sums[y:y + height]), -y, -x)
               for y in range(lines - height + 1) for x in range(columns - width + 1))
    return -best[2] * BLOCK, -best[1] * BLOCK


WHITE = ["--pattern", "constant:color=1,1,1", f"{CELL[0]}x{CELL[1]}", "3"]


def scale():
    """The colours of errors from 0 on the left to 0.5 on the right, as heat_colour of examples/common has them."""
    stops = [(0, 0, 4), (66, 10, 104), (147, 38, 103), (221, 81, 58), (252, 165, 10), (252, 255, 220)]
    height = CELL[1] // 6
    commands = []
    for i in range(5):
        left, right = (",".join(f"{channel / 255:.4f}" for channel in stop) for stop in stops[i:i + 2])
        commands += ["--pattern", f"fill:left={left}:right={right}", f"{CELL[0] // 5}x{height}", "3"]
    return commands + ["--mosaic", "5x1"] + WHITE + ["--paste", f"+0+{(CELL[1] - height) // 2}"]


def compose(path, truth, pairs, size, cell, judged=None):
    """The truth and pictures in rows of four, each with its heat map under it; under the truth the scale. All are cut to
    the `cell` in which the errors of those `judged`, or of all, are largest."""
    part = min(cell[0], size[0]), min(cell[1], size[1])
    x, y = window([heat_map for _, heat_map in judged or pairs], size, part)

    def cut(picture):
        return [picture, "--cut", f"{part[0]}x{part[1]}+{x}+{y}", "--resize:filter=box", f"{CELL[0]}x{CELL[1]}"]

    cells = [(cut(truth), scale())] + [(cut(picture), cut(heat_map)) for picture, heat_map in pairs]
    columns = min(COLUMNS, len(cells))
    cells += [(WHITE, WHITE)] * (-len(cells) % columns)
    commands = []
    for first in range(0, len(cells), columns):
        for which in (0, 1):
            commands += [word for pair_of_cells in cells[first:first + columns] for word in pair_of_cells[which]]
    path.parent.mkdir(parents=True, exist_ok=True)
    oiiotool(*commands, "--mosaic:pad=4", f"{columns}x{2 * len(cells) // columns}", "--ch", "R,G,B", "-d", "uint8", "-o",
             path)


def compose_all(device, target):
    for case_rows in shown_cases(device):
        row = case_rows[0]
        truth = picture_of(device, truth_stem(row))
        chosen = shown(device, case_rows)
        if truth and chosen:
            compose(target / f"{rows.plain(row['case'])}.png", truth, [pair(device, row) for row in chosen],
                    (row["width"], row["height"]), CELL)
    found = worst(device)
    if found:
        _, row, pcss = found
        truth = picture_of(device, truth_stem(row))
        if truth:
            # Enlarged: errors of single texels can be seen.
            compose(target / "worst.png", truth, [pair(device, pcss), pair(device, row)], (row["width"], row["height"]),
                    (CELL[0] // 3, CELL[1] // 3), judged=[pair(device, row)])


def shrunk(svg):
    """gnuplot writes many groups with nothing in them."""
    return re.sub(r"[ \t]*<g [^>]*>\s*</g>\n", "", svg)


def update(devices, target):
    for device in devices:
        folder = target / device.folder_name
        plots = [plot for beside in device.folders for plot in sorted((beside / "plots").glob("*.svg"))]
        if plots:
            folder.mkdir(parents=True, exist_ok=True)
            for old in folder.glob("*.svg"):
                old.unlink()
        for plot in plots:
            (folder / plot.name).write_text(shrunk(plot.read_text()))
        if any((beside / "images").is_dir() for beside in device.folders):
            for old in folder.glob("*.png"):
                old.unlink()
            compose_all(device, folder)
