"""Reads what Lockstep writes: images, comparisons, profiles, statistics.

    import lockstep
    image = lockstep.load_image("reef.exr")
    image.pixels.shape, image.settings["sampler"]    # (480, 720, 3), 'owen'

    comparison = lockstep.load_comparison("out/compare")
    comparison.errors["flip_ldr"]                    # a column of errors.csv

Needs Python 3.10, numpy, and for images OpenImageIO (Debian: python3-numpy, python3-openimageio).
What cannot be read is a LockstepError of one line: which file, what is wrong with it, what to do.
"""

import csv
import dataclasses
import io
import json
import pathlib

import numpy

__all__ = [
    "Comparison",
    "Image",
    "LockstepError",
    "Profile",
    "load_comparison",
    "load_image",
    "load_profile",
    "load_stats",
]


class LockstepError(Exception):
    """What could not be read, and what to do."""


@dataclasses.dataclass
class Image:
    """An image file.

    pixels: float32, shape (height, width, channels), the top row first. EXR files hold linear
        radiance; those of 8 or 16 bits are shares of the largest value, still in the sRGB curve.
    settings: what made the image, as its header has it ("sampler", "spp", "cpu_seconds", ...);
        numbers as int or float, "resolution" as (width, height), "biased" as bool. Empty where
        another program wrote the file.
    """

    path: pathlib.Path
    pixels: numpy.ndarray
    settings: dict


@dataclasses.dataclass
class Comparison:
    """What `lockstep compare -o DIR` leaves in DIR.

    errors: a structured array, a row for each render, with the columns of errors.csv.
    summary: summary.json; None in a comparison that was killed before its first scene was done.
    journal: the lines of journal.jsonl that tell of renders, in the order of measurement: those
        with "run" are the rows of `errors`, those with "repeat" were rendered for their time alone.
    """

    directory: pathlib.Path
    errors: numpy.ndarray
    summary: dict | None
    journal: list

    @property
    def complete(self):
        """Whether every render that was asked for is there."""
        return bool(self.summary and self.summary["complete"])

    def experiments(self):
        """The (scene, depth) pairs, in order of measurement."""
        return _distinct((str(row["scene"]), int(row["depth"])) for row in self.errors)

    def samplers(self):
        """Their names, in the order in which the comparison was asked for them."""
        if self.summary and self.summary["scenes"]:
            return [s["sampler"] for s in self.summary["scenes"][0]["samplers"]]
        return _distinct(str(name) for name in self.errors["sampler"])

    def rows(self, **values):
        """The rows of `errors` with these values: rows(scene="reef", sampler="owen", spp=16)."""
        chosen = numpy.ones(len(self.errors), bool)
        for column, value in values.items():
            if column not in self.errors.dtype.names:
                columns = ", ".join(self.errors.dtype.names)
                raise LockstepError(f"errors.csv has no column {column!r}; it has {columns}")
            chosen &= self.errors[column] == value
        return self.errors[chosen]

    def cpu_seconds(self, scene, depth, sampler, spp):
        """All CPU times of a rung, those of renders that were repeated for their time included."""
        rung = {"scene": scene, "depth": depth, "sampler": sampler}
        times = list(self.rows(**rung, spp=spp)["cpu_seconds"])
        for entry in self.journal:
            repeat = entry.get("repeat")
            if repeat and repeat["spp"] == spp and all(entry.get(k) == v for k, v in rung.items()):
                times.append(float(repeat["cpu_seconds"]))
        return numpy.array(times)


@dataclasses.dataclass
class Profile:
    """What `lockstep profile -o DIR` leaves in DIR: a structured array for each CSV file.

    speeds: profile.csv, rays per CPU second in each traversal mode.
    renders: renders.csv, whole renders.
    coherence: coherence.csv, packets.
    errors: errors.csv; None with `--reference-spp 0`.
    The column "weight" is text in all of them: "0.25", or "c=4 t=0.02" for a map.
    """

    directory: pathlib.Path
    speeds: numpy.ndarray
    renders: numpy.ndarray
    coherence: numpy.ndarray
    errors: numpy.ndarray | None


def load_image(path):
    """Reads an image file that OpenImageIO knows. Returns an Image."""
    path = _existing(path, "an image that `lockstep render` or `compare` wrote")
    try:
        import OpenImageIO
    except ImportError as error:
        raise LockstepError(
            f"{path}: images need OpenImageIO's Python module: install python3-openimageio"
        ) from error
    file = OpenImageIO.ImageInput.open(str(path))
    if file is None:
        reason = OpenImageIO.geterror().strip().replace("\n", " ")
        raise LockstepError(f"{path}: not an image that can be read ({reason})")
    try:
        spec = file.spec()
        pixels = file.read_image(0, 0, 0, spec.nchannels, OpenImageIO.FLOAT)
        if pixels is None:
            reason = file.geterror().strip().replace("\n", " ")
            raise LockstepError(f"{path}: damaged ({reason}); render it again")
        settings = {a.name: a.value for a in spec.extra_attribs}
    finally:
        file.close()
    return Image(path, numpy.ascontiguousarray(pixels), _settings(settings))


def load_comparison(directory):
    """Reads the folder of a comparison, finished or not. Returns a Comparison."""
    directory = _folder(directory, "compare")
    errors = _read_csv(directory / "errors.csv")
    summary = directory / "summary.json"
    journal = directory / "journal.jsonl"
    return Comparison(
        directory,
        errors,
        _read_json(summary) if summary.exists() else None,
        _read_journal(journal) if journal.exists() else [],
    )


def load_profile(directory):
    """Reads the folder of a profile. Returns a Profile."""
    directory = _folder(directory, "profile")
    errors = directory / "errors.csv"
    return Profile(
        directory,
        _read_csv(directory / "profile.csv"),
        _read_csv(directory / "renders.csv"),
        _read_csv(directory / "coherence.csv"),
        _read_csv(errors) if errors.exists() else None,
    )


def load_stats(path):
    """Reads what `lockstep render --stats FILE` wrote. Returns a dict with FILE's keys."""
    path = _existing(path, "what `lockstep render --stats` wrote")
    stats = _read_json(path)
    if not isinstance(stats, dict) or "paths_per_cpu_second" not in stats:
        raise LockstepError(f"{path}: not the statistics of a render (`lockstep render --stats`)")
    return stats


# Columns that are text even where all their values look like numbers.
_TEXT = set("scene sampler lanes isa version kind mode best_mode policy_mode weight at".split())

_PREFIX = "lockstep:"


def _settings(attributes):
    """The header's settings: those with the program's prefix, as numbers where they are some."""
    settings = {}
    for name, value in attributes.items():
        if not name.startswith(_PREFIX):
            continue
        name = name[len(_PREFIX) :]
        if name == "biased":
            value = value == "yes"
        elif name == "resolution":
            value = tuple(int(side) for side in value.split("x"))
        elif name not in _TEXT and isinstance(value, str):
            value = _number(value)
        settings[name] = value
    return settings


def _number(text):
    """An int or a float where the text is one; else the text."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def _distinct(values):
    return list(dict.fromkeys(values))


def _existing(path, what):
    path = pathlib.Path(path)
    if not path.is_file():
        state = "is a folder" if path.is_dir() else "no such file"
        raise LockstepError(f"{path}: {state}; give {what}")
    return path


def _folder(directory, command):
    directory = pathlib.Path(directory)
    if not directory.is_dir():
        state = "no folder" if directory.exists() else "no such folder"
        raise LockstepError(f"{directory}: {state}; give the DIR of `lockstep {command} -o DIR`")
    needed = {"compare": "errors.csv", "profile": "profile.csv"}[command]
    if not (directory / needed).is_file():
        raise LockstepError(
            f"{directory}: holds no {needed}; give the DIR of `lockstep {command} -o DIR`"
        )
    return directory


def _read_text(path):
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise LockstepError(f"{path}: cannot be read ({error})") from error


def _read_json(path):
    try:
        return json.loads(_read_text(path))
    except json.JSONDecodeError as error:
        raise LockstepError(
            f"{path}:{error.lineno}: not JSON ({error.msg}); the file is damaged: make it again"
        ) from error


def _read_journal(path):
    """Lines of renders. What follows the last line break was cut short and does not count."""
    entries = []
    for number, line in enumerate(_read_text(path).split("\n")[:-1], 1):
        try:
            entry = json.loads(line)
        except json.JSONDecodeError as error:
            raise LockstepError(
                f"{path}:{number}: not JSON; `lockstep compare --resume` renders it again once "
                "the line is removed"
            ) from error
        if "note" not in entry:
            entries.append(entry)
    return entries


def _read_csv(path):
    """A structured array: columns are of int, of float (empty: NaN) or text."""
    if not path.is_file():
        raise LockstepError(f"{path}: no such file; the folder is not complete")
    # A render that is being written has no line break yet.
    text = _read_text(path)
    reader = csv.reader(io.StringIO(text[: text.rfind("\n") + 1], newline=""))
    header = next(reader, None)
    if not header:
        raise LockstepError(f"{path}: is empty; make it again")
    rows = []
    for row in reader:
        if len(row) != len(header):
            raise LockstepError(
                f"{path}:{reader.line_num}: {len(row)} fields where the first line names "
                f"{len(header)}; the file is damaged: make it again"
            )
        rows.append(row)
    columns = [_column(name, [row[i] for row in rows]) for i, name in enumerate(header)]
    table = numpy.empty(len(rows), [(n, c.dtype) for n, c in zip(header, columns)])
    for name, column in zip(header, columns):
        table[name] = column
    return table


def _column(name, texts):
    if name in _TEXT:
        return numpy.array(texts, dtype=str)
    for kind in (int, float):
        try:
            return numpy.array([kind(text) if text else float("nan") for text in texts], kind)
        except (ValueError, OverflowError):
            pass
    return numpy.array(texts, dtype=str)
