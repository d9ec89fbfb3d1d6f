"""The interface of an entry, ENTRY TASK SAMPLES SEED OUT, and the table of the task "leaf"."""

import json
import pathlib
import resource
import sys

import numpy

COLUMNS = ["quantity", "light", "theta", "phi", "red", "green", "blue"]


class Task:
    """A task's folder: its numbers as attributes, and `leaf`, R and T of the leaf."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder).resolve()
        self.name = self.folder.name
        self.__dict__ |= json.loads((self.folder / "task.json").read_text(encoding="utf-8"))
        if not hasattr(self, "leaf"):
            self.leaf = json.loads((self.folder.parent / "leaf.json").read_text(encoding="utf-8"))

    def mesh(self, surface, kind="ply"):
        return str(self.folder / f"{surface['mesh']}.{kind}")

    def near_normal(self, side="front"):
        """R and T of the leaf at 8 degrees, each by wavelength."""
        return self.leaf[side]["R"][0], self.leaf[side]["T"][0]


def cpu():
    """CPU seconds of this process and of those that it has waited for."""
    return sum(u.ru_utime + u.ru_stime for u in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))


def main(image, table, versions, brf=None, output=sys.stdout):
    """Runs one entry. `image(task, samples, seed, out)` and `table(task, samples, seed)` return CPU seconds without set-up, and the
    latter the table before; so does `brf`, `[view][wavelength]`, with one more row if the program measures absorbed light. A task that the entry cannot do raises NotImplementedError with the reason, a
    program that is not installed FileNotFoundError."""
    folder, samples, seed, out = sys.argv[1:]
    task = Task(folder)
    try:
        if task.kind == "image":
            seconds = image(task, int(samples), int(seed), out)
        elif task.kind == "leaf":
            rows, seconds = table(task, int(samples), int(seed))
            write_table(out, rows)
        elif brf:
            values, seconds = brf(task, int(samples), int(seed))
            numpy.savetxt(out, values, delimiter=",", header=",".join(map(str, task.wavelengths_nm)), comments="")
        else:
            raise NotImplementedError("measures no BRF")
    except NotImplementedError as reason:
        raise SystemExit(f"cannot: {reason}") from None
    except FileNotFoundError as missing:
        print(missing, file=sys.stderr)
        raise SystemExit(127) from None
    print(json.dumps({"cpu_s": seconds, "setup_s": cpu() - seconds, "versions": versions}), file=output)


def direction(theta, phi):
    """Unit vectors `[...][3]` for angles in degrees; z is the normal of the leaf's front."""
    theta, phi = numpy.radians(theta), numpy.radians(phi)
    return numpy.stack(numpy.broadcast_arrays(numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)), -1)


def lights(task):
    """The directions of light of the rows f: degrees from the front's normal."""
    return [*task.light_theta, *(180 - theta for theta in task.light_theta)]


def views(task):
    """theta and phi of the directions of view, `[row][column]`."""
    return numpy.meshgrid(task.theta, task.phi, indexing="ij")


def rows_of(task, f, shares):
    """The table of `f(light theta)`, `[row][column][color]`, and `shares`, of R, T and S, `[row][color]`."""
    theta, phi = views(task)
    for light in lights(task):
        for values in zip(theta.ravel(), phi.ravel(), f(light).reshape(-1, 3)):
            yield ["f", light, values[0], values[1], *values[2]]
    for name, of in shares.items():
        for angle, color in zip(task.theta, of):
            yield [name, "", angle, "", *color]


def rows_of_bsdf(task, f, sample, seed, rays):
    """The table of a program that evaluates and samples BSDFs. `f(wo, wi)` is without the cosine, `sample(wo)` returns wi and weights."""
    theta, phi = views(task)
    wo = direction(theta, phi).reshape(-1, 3)
    of_light = lambda light: f(wo, numpy.broadcast_to(direction(light, 0), wo.shape))
    random, shares = numpy.random.default_rng(seed), {name: [] for name in "RTS"}
    for angle in task.theta:
        out = numpy.broadcast_to(direction(angle, 0), (rays, 3)).astype(numpy.float32)
        wi, weight = sample(out)
        same = (wi[:, 2:] > 0) == (angle < 90)
        shares["R"].append((weight * same).mean(axis=0, dtype=float))
        shares["T"].append((weight * ~same).mean(axis=0, dtype=float))
        # S, the light of both sides, without the density: cosine-distributed directions of the whole sphere.
        cosine, turn = numpy.sqrt(random.random(rays)), 2 * numpy.pi * random.random(rays)
        sine = numpy.sqrt(1 - cosine**2)
        wi = numpy.stack([sine * numpy.cos(turn), sine * numpy.sin(turn), numpy.where(random.random(rays) < 0.5, 1, -1) * cosine], axis=1)
        shares["S"].append(2 * numpy.pi * f(out, wi.astype(numpy.float32)).mean(axis=0, dtype=float))
    return rows_of(task, of_light, shares)


def rows_of_images(task, render):
    """The table of a program that only renders: `render(sun, sky, front)` is the image [theta][phi][3] of all directions that is seen from
    a point close to the leaf, on its front or back; `sun` is the light's direction, with an irradiance of 1 across it, or None; `sky` has
    the radiances of the upper and lower half of all directions. A pixel shows the light that leaves the leaf toward (theta, phi)."""
    half = numpy.array(task.theta) < 90

    def both(sun, sky_of):
        front, back = (render(sun, sky_of(front), front) for front in (True, False))
        return numpy.where(half[:, None, None], front, back)

    def f(light):
        return both(direction(light, 0), lambda front: (0, 0)) / abs(numpy.cos(numpy.radians(light)))

    skies = {"R": lambda front: (1, 0) if front else (0, 1), "T": lambda front: (0, 1) if front else (1, 0), "S": lambda front: (1, 1)}
    return rows_of(task, f, {name: both(None, sky).mean(axis=1) for name, sky in skies.items()})


def write_table(path, rows):
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(COLUMNS) + "\n")
        file.writelines(",".join(f"{v:.7g}" if not isinstance(v, str) else v for v in row) + "\n" for row in rows)
