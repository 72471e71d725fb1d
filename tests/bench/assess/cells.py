"""What is measured: every cell is one scene, one way and one setting, and runs in a process of its own."""
import dataclasses
import json
import pathlib

import families

data = pathlib.Path(__file__).resolve().parents[2] / "data"
methods = {"full": ("retrace", "progressive"), "baum86": ("back-buffer", "progressive"), "chen90": ("retrace", "incremental"),
           "tost-pueyo93": ("temporal-graph", "active-passive"), "events": ("events", "residual")}
visibilities = ["retrace", "back-buffer", "temporal-graph", "events"]
solutions = ["progressive", "incremental", "active-passive", "residual", "in-view"]
samples = {"cornell-slide": 12, "living-room": 24}  # and the frame that there are references of


@dataclasses.dataclass(frozen=True)
class Form:
    """How much is done."""
    name: str
    rounds: int
    frames: int               # of a sequence in the families
    patch_size_m: float
    rays: int
    values: dict              # of each knob
    even_patches: tuple       # sizes in metres, of the living room, for the growth with patches
    reference_samples: int    # a pixel, of each half
    drawn: range              # numbers of the scenes on which asked errors are judged
    most_frames: int          # of the chapter of that name
    sample_scenes: tuple      # that are measured as well
    hard_scenes: tuple        # generated ones that errors are told of

    @property
    def is_quick(self):
        return self.name == "quick"


def values_of(count):
    """The first, the last and some between of each knob's values; those of the defaults always."""
    chosen = {}
    for family, (_, values) in families.families.items():
        if family == "frames":
            continue
        step = max(1, round(len(values) / count))
        chosen[family] = [v for k, v in enumerate(values) if k % step == 0 or k == len(values) - 1]
    return chosen


hard = ("actors=3", "moving=24", "occlusion=4", "reflectance=0.9")
forms = {
    "quick": Form("quick", 1, 8, 0.4, 64, values_of(2), (0.4, 0.2), 64, range(1, 3), 16, (), ("actors=3",)),
    # Those before the twenty-fifth were looked at while asked errors were settled.
    "medium": Form("medium", 3, 24, 0.25, 128, values_of(5), (0.45, 0.25, 0.14, 0.044, 0.0132), 512, range(25, 37), 128, tuple(samples), hard),
    "long": Form("long", 5, 48, 0.16, 256, values_of(6), (0.45, 0.25, 0.14, 0.08, 0.044, 0.025, 0.0132), 2048, range(25, 55), 512, tuple(samples), hard),
}


@dataclasses.dataclass(frozen=True)
class Cell:
    chapter: str
    scene: str
    way: str
    setting: str
    program: str
    arguments: tuple
    pictures: bool = False
    most_rounds: int = 99

    @property
    def name(self):
        return "~".join(str(part).replace("/", "-").replace(" ", "_") for part in (self.chapter, self.scene, self.way, self.setting))


def sequence(chapter, scene, way, setting, arguments, pictures=True, most_rounds=99):
    return Cell(chapter, scene, way, setting, "sequence_cell", tuple(f"{k}={v}" for k, v in arguments.items()), pictures, most_rounds)


def pair(visibility, solution):
    return {"visibility": visibility, "solution": solution}


def by_family(form):
    """All methods while one knob is turned, and on the sample scenes."""
    common = {"quality": "draft", "patch_size": form.patch_size_m, "rays": form.rays, "frames": f"0-{form.frames - 1}",
              "size": 96, "every": form.frames - 1}
    for family, values in form.values.items():
        for value in values:
            for way, (visibility, solution) in methods.items():
                yield sequence("families", f"{family}={value}", way, "", {**pair(visibility, solution), **common})
            yield sequence("families", f"{family}={value}", "auto", "", common)
            if family == "camera":
                yield sequence("families", f"{family}={value}", "walkthrough", "", {**pair("back-buffer", "in-view"), **common})
    for scene in form.sample_scenes:
        for way, (visibility, solution) in methods.items():
            yield sequence("families", scene, way, "", {**pair(visibility, solution), **common, "patch_size": form.patch_size_m / 2})


def by_axis(form):
    """Each axis alone: visibilities under one solution, and the other way round."""
    common = {"quality": "draft", "patch_size": form.patch_size_m, "rays": form.rays, "frames": f"0-{form.frames - 1}",
              "size": 96, "every": form.frames - 1}
    for scene in ("actors=3", "moving=12", *form.sample_scenes[1:]):
        for visibility in visibilities:
            yield sequence("axes", scene, visibility, "under residual", {**pair(visibility, "residual"), **common})
        for solution in solutions:
            yield sequence("axes", scene, solution, "on events", {**pair("events", solution), **common})


def by_coherence(form):
    """What is reused, one thing at a time and together. A camera that creeps keeps pictures from being reused."""
    common = {"quality": "preview", "patch_size": form.patch_size_m, "rays": form.rays, "frames": f"0-{form.frames - 1}",
              "size": 192, "every": form.frames - 1}
    for scene, picture in (("camera=creeps", "pictures anew"), ("camera=rests", "pictures kept")):
        for visibility in visibilities:
            for solution in ("progressive", "incremental", "residual"):
                yield sequence("coherences", scene, f"{visibility}+{solution}", picture, {**pair(visibility, solution), **common})


def by_quality(form):
    """Error against time, cold and following, beside paths."""
    for scene in form.sample_scenes + form.hard_scenes:
        last = samples.get(scene, 12)
        size = 256 if scene in samples else 96
        finest = ["final"] if scene in samples else []
        for quality in ["draft", "preview", *finest]:
            frames = f"{last - (2 if quality == 'final' else 7)}-{last}"
            for way, (visibility, solution) in methods.items():
                if quality == "final" and way not in ("full", "events"):
                    continue
                yield sequence("quality", scene, way, quality, {**pair(visibility, solution), "quality": quality, "frames": frames,
                                                                "size": size, "every": 99}, most_rounds=1)
            yield sequence("quality", scene, "cold", quality, {**pair("retrace", "progressive"), "quality": quality,
                                                               "frames": f"{last}-{last}", "size": size}, most_rounds=1)
        for count in (4, 16) if form.is_quick else (4, 16, 64):
            yield paths("quality", scene, last, count, size, 1)


def paths(chapter, scene, frame, count, size, seed):
    return Cell(chapter, scene, "path tracer", f"{count} samples", "path_trace", (str(frame), str(count), str(size), "OUT", str(seed)), True, 1)


def by_mesh(form):
    """Even patches beside patches as small as they must be; lines and samples are those of the finest quality."""
    for scene in ("actors=3", *form.sample_scenes):
        last = samples.get(scene, 12)
        common = {"quality": "final", "rays": 256, "frames": f"{last}-{last}", "size": 256 if scene in samples else 96}
        for size in (0.6, 0.35, 0.2, 0.12):
            yield sequence("mesh", scene, "even", size, {**common, "patch_size": size / (2 if scene == "living-room" else 1)}, most_rounds=1)
        yield sequence("mesh", scene, "refined", "final", common, most_rounds=1)
        yield sequence("mesh", scene, "refined", "preview", {**common, "quality": "preview"}, most_rounds=1)


def by_patches(form):
    for size in form.even_patches:
        for way, (visibility, solution) in methods.items():
            yield sequence("patches", "living-room", way, size, {**pair(visibility, solution), "quality": "draft", "patch_size": size,
                                                                 "rays": 64, "frames": "24-29", "size": 64}, False, 1 if size < 0.02 else 2)


def by_frames(form):
    """One run a method; what n frames cost is the sum of the first n."""
    for scene in ("frames=128", *form.sample_scenes[1:]):
        for way, (visibility, solution) in methods.items():
            last = min(form.most_frames, 96 if scene == "living-room" else form.most_frames) - 1
            yield sequence("frames", scene, way, "", {**pair(visibility, solution), "quality": "draft", "patch_size": form.patch_size_m,
                                                      "rays": form.rays, "frames": f"0-{last}", "size": 64}, False, 1)


def by_flicker(form):
    count = 4 if form.is_quick else 12
    for scene in ("actors=3", *form.sample_scenes[1:]):
        common = {"frames": f"6-{5 + count}", "size": 64}
        for seed in (11, 12):
            yield sequence("flicker", scene, "truth", seed, {**pair("events", "residual"), "quality": "final", "rays": 512,
                                                             "error": 0.002, "seed": seed, **common}, most_rounds=1)
        for way, (visibility, solution) in methods.items():
            yield sequence("flicker", scene, way, "preview", {**pair(visibility, solution), "quality": "preview", **common}, most_rounds=1)
        for frame in range(6, 6 + count):
            yield paths("flicker", scene, frame, 64, 64, frame)


def by_part(form):
    for part in ("lines", "factors", "orders", "certificates"):
        for scene in ("actors=3",) if form.is_quick else ("actors=3", "reflectance=0.9", "occlusion=4", "living-room"):
            yield Cell(f"parts: {part}", scene, "all", "", "parts_cell", (part, str(form.patch_size_m), str(form.rays)), False, 2)


def by_asked(form):
    """Asked errors on scenes nobody tuned for, beside fixed settings."""
    fixed = [("draft", 64), ("draft", 128), ("preview", 64), ("preview", 128), ("preview", 256), ("preview", 512), ("final", 128),
             ("final", 256), ("final", 512)]
    for k in form.drawn:
        common = {**pair("retrace", "progressive"), "frames": "0-0", "size": 96}
        for asked in (0.05, 0.02):
            yield sequence("asked", f"drawn={k}", "asked", asked, {"error": asked, **common}, most_rounds=2)
            yield sequence("asked", f"drawn={k}", "asked, following", asked, {"error": asked, "frames": "4-12", "size": 96, "every": 99},
                           most_rounds=1)
        for quality, rays in fixed:
            yield sequence("asked", f"drawn={k}", "fixed", f"{quality}, {rays} lines", {"quality": quality, "rays": rays, **common}, most_rounds=2)


chapters = [by_quality, by_asked, by_family, by_axis, by_coherence, by_mesh, by_patches, by_frames, by_flicker, by_part]


def all_cells(form):
    return [cell for chapter in chapters for cell in chapter(form)]


def references(form):
    """(scene, frame, pixels along an edge) of the pictures that errors are told by."""
    # The quick form is over before they were traced.
    generated = [f"{family}={value}" for family, values in form.values.items() for value in values if not form.is_quick]
    return [*((scene, 12, 96) for scene in form.hard_scenes), *((f"drawn={k}", frame, 96) for k in form.drawn for frame in (0, 12)),
            *((scene, form.frames - 1, 96) for scene in generated)]


def room_of(scene):
    family, value = scene.split("=")
    if family == "drawn":
        return families.drawn(int(value))
    return families.member(family, {str(v): v for v in families.families[family][1]}[value])


def written(path, document):
    """The path of a document that is now there."""
    text = json.dumps(document)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return path


def scene_file(scene, folder):
    """Where a scene is; generated ones are written first."""
    if scene in samples:
        return data / f"{scene}.glb"
    return written(folder / f"{scene}.json", families.scene(room_of(scene)))


def lamps_file(scene, folder):
    """A generated scene of which only the lamps can be seen."""
    document = families.scene(room_of(scene))
    for material in document["materials"]:
        material["reflectance"] = 0
    return written(folder / "lamps" / f"{scene}.json", document)
