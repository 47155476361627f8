#!/usr/bin/env python3
"""What hides the important fades: the figures of lerzer2025, measured and shown (docs/visibility.md).

visibility_study.py [--full] [--only 2,8,...] [--folder DIR]; leaves CSVs, pictures and index.html. Pictures that are there already and were
made by the same command are kept, so that a study that was interrupted goes on; their times are those of their first making.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys

import svg_plots as plots
import visibility_scenes as scenes
from study_page import Page, table
from visibility_scenes import CT, GLOWING, HIGHLIGHTS, MRI, changed, lights, marched

PROGRAM = pathlib.Path(os.environ.get("VOXLUME", scenes.TOP / "build/release/voxlume"))
LISTS = pathlib.Path(os.environ.get("VOXLUME_LISTS", scenes.TOP / "build/release/experiments/voxlume_list_convergence"))
COLOURS = ".tracked{--c:#d1493f}.marched{--c:#3f7fc4}.jittered{--c:#3d9950}.denoised{--c:#d79a2b}.total{--c:#d1493f}.inside{--c:#3f7fc4}"
FULL_EDGE, FULL_REFERENCE = 800, 10000


class Study:
    def __init__(self, folder, full, edge=None, samples=None):
        """`edge` [pixels] and `samples` a pixel take the place of all others."""
        self.folder, self.full, self.samples = folder, full, samples
        self.edge = edge or (FULL_EDGE if full else 200)
        self.data_sets = 2
        (folder / "pictures").mkdir(parents=True, exist_ok=True)

    def spp(self, full, otherwise):
        return self.samples or (full if self.full else otherwise)

    def picture(self, name, scene, spp=None, seconds=None, seed=1, edge=None, denoise=None, size=None):
        """Renders pictures/NAME.exr and .png unless that was done; the statistics."""
        exr, png, scene_file, stats = (self.file(name, ending) for ending in ("exr", "png", "json", "stats.json"))
        width, height = size or (edge or self.edge, edge or self.edge)
        scene = changed(scene, {"image": {"width": width, "height": height}, "render": {"seed": seed}})
        for key, value in (("spp", spp), ("seconds", seconds)):
            if value is not None:
                scene["image"][key] = value
        if denoise:
            scene["render"]["denoise"] = denoise
        text = json.dumps(scene, indent=1)
        if not (stats.exists() and scene_file.exists() and scene_file.read_text() == text):
            stats.unlink(missing_ok=True)
            png.unlink(missing_ok=True)
            scene_file.write_text(text)
            print(f"visibility: {name}", file=sys.stderr)
            run("render", scene_file, "-o", exr, "--stats", stats)
        if not png.exists():
            run("convert", exr, png)
        return json.loads(stats.read_text())

    def file(self, name, ending):
        return self.folder / "pictures" / f"{name}.{ending}"

    def reference(self, name, scene, spp, **how):
        """A picture of many samples, and how far it is from the truth [RMSE], from another of a quarter of them."""
        stats = self.picture(name, scene, spp=spp, seed=1001, **how)
        self.picture(name + "-other", scene, spp=max(spp // 4, 1), seed=1002, **how)
        # The squared difference has five times the reference's own variance.
        return stats, self.compare(name + "-other", name)["rmse"] / 5 ** 0.5

    def compare(self, name, reference):
        """RMSE of linear values, and FLIP of what a display shows."""
        return json.loads(run("compare", self.file(name, "exr"), self.file(reference, "exr"), "--metric", "rmse,flip", "--json"))

    def table(self, name, header, rows):
        with open(self.folder / f"{name}.csv", "w", newline="") as file:
            csv.writer(file).writerows([header, *rows])
        return table(header, rows)


def run(*arguments):
    done = subprocess.run([str(PROGRAM), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"visibility: {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return done.stdout


def shrinking_steps(study, page):
    page.add("<h2>Fig. 2: sums depend on the step</h2><p>Ray marching of glowing matter, bone of importance 0.9. Above by sums over the steps (Ament et al. 2017, eq. 4, with "
             "the q and r of its own scale, 7 and 3): as steps shrink sums grow without bound and even the important fades. Below by integrals (eq. 8): the same at every step.</p>")
    rows, shown = [], []
    scene = changed(CT, GLOWING, {"visibility": {"important": [{"range": [300, 1e12], "importance": 0.9}]}, "image": {"exposure_ev": -1.5}})
    for sums, weights in (("discrete", {"q": 7, "r": 3}), ("integral", {})):
        for step in (0.01, 0.001, 0.0001):
            name = f"fig2-{sums}-{step}"
            stats = study.picture(name, changed(scene, marched("ct", step, sums=sums), {"visibility": weights}), spp=1, edge=study.edge * 4 // 5)
            rows.append([sums, step, stats["mean_luminance"], stats["wall_s"]])
            shown.append((name, f"{sums}, step {step}: mean luminance {stats['mean_luminance']:.4f}"))
    page.pictures(shown)
    page.add(study.table("fig2", ["sums", "step, half sides", "mean luminance", "seconds"], rows))


def equal_time(study, page):
    page.add("<h2>Fig. 5: as long as ray marching takes</h2><p>Marching with a step at which bands are just gone, without jitter, and path tracing for the same time, against "
             "path tracing of many samples; with light rays freed and without. Light rays are looked at 200 times when tracked, at every step when marched.</p>")
    rows, shown = [], []
    for data, scene, step in (("ct", CT, 0.004), ("mri", MRI, 0.004))[:study.data_sets]:
        for which in ("off", "first"):
            optimized = changed(scene, lights(which))
            name = f"fig5-{data}-{which}"
            plain = study.picture(f"fig5-{data}-plain", changed(scene, {"visibility": None}), spp=study.spp(1000, 128))
            _, floor = study.reference(name + "-reference", optimized, study.spp(FULL_REFERENCE, 1500 if which == "off" else 600))
            march = study.picture(name + "-marched", changed(optimized, marched(data, step)), spp=1)
            track = study.picture(name + "-tracked", optimized, seconds=march["wall_s"])
            for method, stats in (("marched", march), ("tracked", track)):
                error = study.compare(f"{name}-{method}", name + "-reference")
                rows.append([data, which, method, stats["wall_s"], stats["spp"], error["rmse"], error["flip"], floor])
                shown.append((f"{name}-{method}", f"{data}, lights {which}, {method}: RMSE {error['rmse']:.4f}, FLIP {error['flip']:.4f}"))
            shown.append((name + "-reference", f"{data}, lights {which}, reference"))
        shown.append((f"fig5-{data}-plain", f"{data}, nothing freed, {plain['wall_s']:.1f} s"))
    page.pictures(shown)
    page.add(study.table("fig5", ["data", "lights", "method", "seconds", "samples", "RMSE", "FLIP", "reference's own RMSE"], rows))


def little_time(study, page):
    page.add("<h2>Fig. 6: little time, highlights</h2><p>The time of one marched picture with steps of 0.008, Blinn-Phong highlights with exponent 40. Jitter turns bands into noise, which a "
             "denoiser takes out; steps that miss the narrow shell of a surface lose its highlight.</p>")
    scene = changed(CT, HIGHLIGHTS)
    _, floor = study.reference("fig6-reference", scene, study.spp(FULL_REFERENCE, 1500))
    base = study.picture("fig6-marched", changed(scene, marched("ct", 0.008)), spp=1)
    jittered = changed(scene, marched("ct", 0.008, jitter=True))
    cases = [("marched", "marched, no jitter", base),
             ("jittered", "marched, jitter", study.picture("fig6-jittered", jittered, spp=1)),
             ("jittered-denoised", "marched, jitter, denoised", study.picture("fig6-jittered-denoised", jittered, spp=1, denoise="decoupled")),
             ("tracked", "tracked", study.picture("fig6-tracked", scene, seconds=base["wall_s"])),
             ("tracked-denoised", "tracked, denoised", study.picture("fig6-tracked-denoised", scene, seconds=base["wall_s"], denoise="decoupled"))]
    rows, shown = [], []
    for name, title, stats in cases:
        error = study.compare("fig6-" + name, "fig6-reference")
        rows.append([title, stats["wall_s"], stats["spp"], error["rmse"], error["flip"], floor])
        shown.append(("fig6-" + name, f"{title}: RMSE {error['rmse']:.4f}, FLIP {error['flip']:.4f}"))
    page.pictures(shown + [("fig6-reference", "reference")])
    page.add(study.table("fig6", ["method", "seconds", "samples", "RMSE", "FLIP", "reference's own RMSE"], rows))


def list_convergence(study, page):
    page.add("<h2>Fig. 7: lists tend to the truth</h2><p>A step function on [0, 10] with runs as narrow as 0.003, 48 looks a pass: the error of the integral of its square, over all and up to "
             "t = 5.</p>")
    path = study.folder / "fig7.csv"
    path.write_text(subprocess.run([str(LISTS)], check=True, stdout=subprocess.PIPE, text=True).stdout)
    rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(path.open())]
    least = 1e-9  # what a logarithm can show
    page.key([("total", "over all"), ("inside", "up to t = 5")])
    page.plots([plots.lines("error of the integral", "", "looks", [(c, c, [(r["looks"], max(r[k], least)) for r in rows])
                                                                  for c, k in (("total", "error"), ("inside", "error_at_5"))], log_y=True)])
    page.add(table(["pass", "looks", "segments", "error", "error up to 5"],
                   [[int(r["pass"]), int(r["looks"]), int(r["segments"]), f"{r['error']:.2g}", f"{r['error_at_5']:.2g}"]
                    for r in rows if r["pass"] in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512)]))


def error_over_samples(study, page):
    page.add("<h2>Fig. 8: error over samples</h2>")
    ladder = [1, 4] if study.samples else [1, 4, 16, 64, 256] + ([1000, 4000] if study.full else [])
    rows, curves, shown = [], {}, []
    for which in ("off", "first"):
        name = f"fig5-ct-{which}-reference"
        scene = changed(CT, lights(which))
        _, floor = study.reference(name, scene, study.spp(FULL_REFERENCE, 1500 if which == "off" else 600))
        for spp in ladder:
            stats = study.picture(f"fig8-{which}-{spp}", scene, spp=spp)
            error = study.compare(f"fig8-{which}-{spp}", name)
            rows.append([which, spp, stats["wall_s"], error["rmse"], error["flip"], floor])
            curves.setdefault(which, []).append((spp, error["rmse"]))
            if which == "first":
                shown.append((f"fig8-{which}-{spp}", f"{spp} samples, {stats['wall_s']:.1f} s: RMSE {error['rmse']:.4f}"))
    page.key([("tracked", "camera rays"), ("marched", "camera and light rays")])
    page.plots([plots.lines("RMSE", "", "samples a pixel", [("tracked", "off", curves["off"]), ("marched", "first", curves["first"])], log_x=True, log_y=True)])
    page.pictures(shown)
    page.add(study.table("fig8", ["lights", "samples", "seconds", "RMSE", "FLIP", "reference's own RMSE"], rows))


def scatterings(study, page):
    page.add("<h2>Fig. 9: single and multiple scattering</h2><p>Highlights. Light rays freed at the first scattering, or at all: what the important shadows is lit by light that was scattered on "
             "its way.</p>")
    rows, shown = [], []
    scene = changed(CT, HIGHLIGHTS, {"material": {"highlight": 0.5}, "image": {"exposure_ev": -1}})
    for name, title, change in (("single", "one scattering, light rays freed", [lights("first")]),
                                ("first", "up to 16 scatterings, the first one's light rays freed", [lights("first"), {"render": {"max_scatter": 16}}]),
                                ("all", "up to 16 scatterings, all light rays freed", [lights("all"), {"render": {"max_scatter": 16}}])):
        stats = study.picture("fig9-" + name, changed(scene, *change), spp=study.spp(2000, 64))
        rows.append([title, stats["spp"], stats["wall_s"], stats["mean_luminance"]])
        shown.append(("fig9-" + name, f"{title}: {stats['wall_s']:.1f} s"))
    page.pictures(shown)
    page.add(study.table("fig9", ["light", "samples", "seconds", "mean luminance"], rows))


def parameters(study, page):
    page.add("<h2>Fig. 10: r, and importances 0.75 and 1</h2><p>Deep nuclei and hippocampus of an atlas, by signed distance: those of the patient's left have importance 0.75, those of the right 1, in thin matter. "
             "r fades what is behind.</p>")
    important = [{"volume": "left", "range": [0, 1e12], "importance": 0.75}, {"volume": "right", "range": [0, 1e12], "importance": 1}]
    rows, shown = [], []
    for r in (0, 10, 30, 70):
        scene = changed(MRI, lights("first"), {"visibility": {"important": important, "r": r}, "transfer": {"density_scale": 0.06},
                        "camera": {"azimuth_deg": 0, "elevation_deg": 15, "zoom": 2.4}})
        stats = study.picture(f"fig10-{r}", scene, spp=study.spp(2000, 64))
        rows.append([r, stats["wall_s"], stats["mean_luminance"]])
        shown.append((f"fig10-{r}", f"r = {r}"))
    page.pictures(shown)
    page.add(study.table("fig10", ["r", "seconds", "mean luminance"], rows))


def thin_shell(study, page):
    page.add("<h2>Fig. 11: looking after interpolating, or before</h2><p>Important is the border of bone alone, values from 250 to 330. A shell so thin lies between voxels: "
             "looked up voxel by voxel it is lost or smeared.</p>")
    rows, shown = [], []
    for lookup in ("interpolated", "per-voxel", "smoothed"):
        scene = changed(CT, {"visibility": {"important": [{"range": [250, 330]}], "lookup": lookup, "q": 700, "r": 300}, "camera": {"zoom": 3}})
        stats = study.picture(f"fig11-{lookup}", scene, spp=study.spp(2000, 256))
        error = study.compare(f"fig11-{lookup}", "fig11-interpolated") if lookup != "interpolated" else {"rmse": 0.0, "flip": 0.0}
        rows.append([lookup, stats["wall_s"], error["rmse"], error["flip"]])
        shown.append((f"fig11-{lookup}", lookup))
    page.pictures(shown)
    page.add(study.table("fig11", ["importance", "seconds", "RMSE to interpolated", "FLIP to interpolated"], rows))


def light_looks(study, page):
    page.add("<h2>Fig. 12: looks along a light ray</h2>")
    spp = study.spp(5000, 200)
    rows, shown = [], []
    scene = changed(CT, {"camera": {"zoom": 2}})
    _, floor = study.reference("fig12-reference", changed(scene, lights("first", 1000)), spp)
    for looks in (10, 25, 50, 100, 200):
        stats = study.picture(f"fig12-{looks}", changed(scene, lights("first", looks)), spp=spp)
        error = study.compare(f"fig12-{looks}", "fig12-reference")
        rows.append([looks, stats["wall_s"], 10 * error["rmse"], error["flip"], 10 * floor])
        shown.append((f"fig12-{looks}", f"{looks} looks, {stats['wall_s']:.1f} s: RMSE x 10 {10 * error['rmse']:.4f}"))
    page.pictures(shown + [("fig12-reference", "1000 looks")])
    page.add(study.table("fig12", ["looks", "seconds", "RMSE x 10", "FLIP", "reference's own RMSE x 10"], rows))


def sizes(study, page):
    page.add("<h2>Table 3: memory and time of a frame</h2><p>Ten samples a pixel. Memory is that of the lists of all pixels, time that of the samples; the paper's lists take 544 and 576 MB, 2752 and 2912, 2144 and 1664 "
             "at these sizes.</p>")
    rows = []
    for data, scene in (("ct", CT), ("mri", MRI))[:study.data_sets]:
        for width, height in ((800, 800), (1600, 1600), (1920, 1080)):
            if study.samples:
                width, height = width // 20, height // 20
            stats = study.picture(f"table3-{data}-{width}", scene, spp=10, size=(width, height))
            rows.append([data, f"{width} x {height}", stats["importance_list_mb"], stats["importance_list_s"], 1000 * stats["wall_s"]])
    page.add(study.table("table3", ["data", "size", "lists, MB", "finding lists, s", "frame, ms"], rows))


FIGURES = {"2": shrinking_steps, "5": equal_time, "6": little_time, "7": list_convergence, "8": error_over_samples, "9": scatterings,
           "10": parameters, "11": thin_shell, "12": light_looks, "t3": sizes}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--full", action="store_true", help="the paper's sizes: 800 x 800, references of 10000 samples; takes hours")
    parser.add_argument("--only", help="figures, such as 2,8,t3")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--edge", type=int, help="of pictures, in pixels")
    parser.add_argument("--samples", type=int, help="a pixel, for all pictures, however few: to try things out")
    parser.add_argument("--ct", help="a volume in place of the sample data, of which the MRI is left out")
    options = parser.parse_args()
    chosen = options.only.split(",") if options.only else list(FIGURES)
    unknown = [f for f in chosen if f not in FIGURES]
    if unknown:
        parser.error(f"no figure {unknown[0]}; there are {', '.join(FIGURES)}")
    folder = options.folder or scenes.TOP / ("out/experiments/visibility-full" if options.full else "out/experiments/visibility")
    if options.ct:
        CT["volume"]["path"] = options.ct
    study, page = Study(folder, options.full, options.edge, options.samples), Page(folder, COLOURS)
    if options.ct:  # and no MRI
        study.data_sets = 1
        chosen = [f for f in chosen if f != "10"]
    page.add(f"<p>{study.edge} x {study.edge} pixels where nothing else is said, rays through the middles of pixels, the head CT and an MRI with an atlas. p = 1, q = 70, r = 30, "
             "lambda = 1, 200 looks along a light ray, unless it says so. A reference's own RMSE, to the truth, follows from a second one with other random numbers.</p>")
    for figure in chosen:
        FIGURES[figure](study, page)
    page.write("What hides the important fades")
    print(f"the page is {folder / 'index.html'}")


if __name__ == "__main__":
    main()
