"""Lens files in the shapes that real ones have, made of the prescriptions in assets, and an own paraxial trace of them.

Nothing here is shared with vkfv but the numbers of the prescriptions: surfaces, and indices at the F, d and C lines.
"""
import math
import pathlib
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINES_UM = {"F": 0.4861327, "d": 0.5875618, "C": 0.6562725}


class Lens:
    """Surfaces as (curvature, thickness, medium behind, semi-diameter) in mm, in the order of light; media by name."""

    def __init__(self, name, surfaces, media):
        self.name, self.surfaces, self.media = name, surfaces, media

    @staticmethod
    def of(file):
        table = tomllib.loads(file.read_text())
        surfaces = []
        for surface in table["surface"]:
            radius = surface.get("radius_mm", 0)
            curvature = 1 / radius if radius else surface.get("curvature_per_mm", 0.0)
            surfaces.append([curvature, surface.get("thickness_mm", 0.0), surface.get("medium", "air"),
                             surface.get("semi_diameter_mm", 100.0)])
        surfaces[-1][1] = 0.0
        media = {name: coefficients(medium["wavelengths_um"], medium["indices"])
                 for name, medium in table.get("media", {}).items() if "indices" in medium}
        return Lens(f"{file.parent.name}/{file.stem}", surfaces, media)

    def index(self, medium, wavelength_um):
        return 1.0 if medium == "air" else index(self.media[medium], wavelength_um)

    def turned(self):
        behind = ["air"] + [medium for _, _, medium, _ in self.surfaces[:-1]]
        distances = [0.0] + [distance for _, distance, _, _ in self.surfaces[:-1]]
        return Lens(self.name, [[-curvature, distance, medium, radius] for (curvature, _, _, radius), distance, medium in
                                zip(reversed(self.surfaces), reversed(distances), reversed(behind))], self.media)

    def focal_lengths(self, wavelength_um):
        """The effective and the back focal length, by a ray that comes parallel to the axis."""
        height, slope, before = 1.0, 0.0, 1.0
        for curvature, distance, medium, _ in self.surfaces:
            behind = self.index(medium, wavelength_um)
            slope = (before * slope - height * curvature * (behind - before)) / behind
            last = height
            height += distance * slope
            before = behind
        return -1 / slope, -last / slope


def coefficients(wavelengths_um, indices):
    """Conrady's n = a + b / x + c / x^3.5 through three indices, by elimination; a single index has no dispersion."""
    if len(indices) == 1:
        return [indices[0], 0.0, 0.0]
    rows = [[1.0, 1 / x, x ** -3.5, n] for x, n in zip(wavelengths_um, indices)]
    for column in range(3):
        pivot = rows.pop(max(range(column, 3), key=lambda row: abs(rows[row][column])))
        rows.insert(column, pivot)
        for row in range(3):
            if row != column:
                share = rows[row][column] / rows[column][column]
                rows[row] = [a - share * b for a, b in zip(rows[row], rows[column])]
    return [rows[k][3] / rows[k][k] for k in range(3)]


def index(conrady, wavelength_um):
    return conrady[0] + conrady[1] / wavelength_um + conrady[2] / wavelength_um ** 3.5


def catalogue(media, off=0.0):
    """An AGF file. Names begin with a letter, as glasses' names do."""
    lines = ["CC made for a test"]
    for name, (a, b, c) in media.items():
        nd, nf, nc = (index((a + off, b, c), LINES_UM[line]) for line in "dFC")
        abbe = (nd - 1) / (nf - nc) if nf != nc else 0
        lines += [f"NM {glass(name)} 5 0 {nd:.6f} {abbe:.2f} 0 1", f"CD {a + off:.15E} {b:.15E} {c:.15E} 0 0 0 0 0 0 0",
                  "TD 0 0 0 0 0 0 20", "LD 3.0E-1 2.5E+0", "IT 4.0E-1 9.9E-1 2.5E+1"]
    return "\r\n".join(lines) + "\r\n"


def glass(medium):
    return medium if medium[0].isalpha() else "G" + medium


HEADER = ["VERS 140124 258 36214", "MODE SEQ", 'NAME "A lens"']
WAVELENGTHS = ["WAVM 1 4.8613270E-1 1", "WAVM 2 5.8756180E-1 1", "WAVM 3 6.5627250E-1 1"]


def file_of(lens, *, unit="MM", scale=1.0, header=(), in_surfaces=(), behind=(), wavelengths=WAVELENGTHS, primary=2,
            kind="STANDARD", dummies=False, fold=False, object_distance="INFINITY"):
    """Lines of a .zmx file. scale: mm per unit. fold: a mirror between the last surface and the image."""
    lines = [*HEADER, f"UNIT {unit} X W X CM MR CPMM", "ENPD 1.0", "ENVD 2.0E+1 1 0", *header, "FTYP 0 0 1 3 0 0 0",
             *wavelengths, f"PWAV {primary}", "GCAT VENDORA MISC"]
    count = 0

    def surface(curvature, distance, medium="air", *more, surface_kind="STANDARD", radius=100.0):
        nonlocal count
        text = distance if isinstance(distance, str) else f"{distance / scale:.16E}"
        lines.extend([f"SURF {count}", f"  TYPE {surface_kind}", *(f"  {line}" for line in in_surfaces),
                      f"  CURV {curvature * scale:.16E} 0 0 0 0 \"\"", f"  DISZ {text}", f"  DIAM {radius / scale:.16E} 1 0 0 1 \"\""])
        if medium not in ("air", "MIRROR"):
            lines.append(f"  GLAS {glass(medium)} 0 0 1.5 40 0 0 0 0 0 0")
        elif medium == "MIRROR":
            lines.append("  GLAS MIRROR 0 0 1.5 40 0 0 0 0 0 0")
        lines.extend(f"  {line}" for line in more)
        count += 1

    surface(0.0, object_distance)
    for k, (curvature, distance, medium, radius) in enumerate(lens.surfaces):
        stop = ["STOP"] if k == 0 else []
        last = k + 1 == len(lens.surfaces)
        surface(curvature, 10.0 if last else distance, medium, *stop, surface_kind=kind, radius=radius)
        if dummies and medium == "air" and not last:
            surface(0.0, 0.0)
    if fold:
        surface(0.0, 0.0, "air", "PARM 3 45", surface_kind="COORDBRK")
        surface(0.0, 0.0, "MIRROR")
        surface(0.0, -10.0, "air", "PARM 3 45", surface_kind="COORDBRK")
    surface(0.0, 0.0)
    return [*lines, *behind]


ADMINISTRATIVE = ["WAVN 0.4861327 0.5875618", "AUTH Somebody", "DBDT 01", "LANG 0", "SSID 12", "FCOM a note", "SDMA 0 1 0"]
OF_SURFACES = ["SCOL 1", "LUID 77", "IWDP 0", "TOLE 1 2", "SLAB 3", "HIDE 0 0 0 0 0 0 0 0 0 0", "MIRR 2 0"]
BEHIND = ["BLNK", "TOL TOFF   0   0              0              0   0 0 0 0 0", "MNUM 1 1", 'MOFF   0   1 "" 0 0 0 1 1 0 0.0 "" 0',
          "EFFL 0 2 0 0 0 0 1.0E+1 1 0 0"]


def text_of(lines, end="\r\n"):
    return end.join(lines) + end


def shapes_of(lens):
    """Name, bytes of a file, options of the import, focal lengths at the primary wavelength."""
    d, f = (lens.focal_lengths(LINES_UM[line]) for line in "dF")
    plain = file_of(lens)
    yield "UTF-16 with everything around", text_of(file_of(lens, header=ADMINISTRATIVE, in_surfaces=OF_SURFACES,
                                                         behind=BEHIND)).encode("utf-16"), [], d
    yield "UTF-16 without a mark", text_of(plain).encode("utf-16-le"), [], d
    yield "Latin-1", text_of([*plain, "NOTE 0 Länge in µm ±1 °"], "\n").encode("latin-1"), [], d
    yield "inches", text_of(file_of(lens, unit="IN", scale=25.4)).encode(), [], d
    yield "metres, the F line", text_of(file_of(lens, unit="METER", scale=1000, primary=1)).encode(), [], f
    yield "WAVL", text_of(file_of(lens, wavelengths=["WAVL 0.4861327 0.5875618 0.6562725"])).encode(), [], d
    yield "aspheres that are spheres", text_of(file_of(lens, kind="EVENASPH", in_surfaces=["PARM 1 0", "PARM 8 0",
                                                                                         "XDAT 1 0"])).encode(), [], d
    yield "plane surfaces between", text_of(file_of(lens, dummies=True)).encode(), [], d
    yield "folded", text_of(file_of(lens, fold=True)).encode(), [], d
    yield "turned round", text_of(file_of(lens.turned())).encode(), ["--reverse"], d
    behind = ["MNUM 2 1"]
    for k, (curvature, distance, _, _) in enumerate(lens.surfaces):
        behind += [f"CRVT {k + 1} 1 {2 * curvature:.16E} 0 0 0 1 1 1 0 0 \"\" 0",
                   f"CRVT {k + 1} 2 {curvature:.16E} 0 0 0 1 1 1 0 0 \"\" 0",
                   f"THIC {k + 1} 1 {distance + 1:.16E} 0 0 0 1 1 1 0 0 \"\" 0",
                   f"THIC {k + 1} 2 {distance:.16E} 0 0 0 1 1 1 0 0 \"\" 0"]
    other = Lens(lens.name, [[2 * curvature, distance + 1, medium, radius] for curvature, distance, medium, radius in
                             lens.surfaces],
                 lens.media)
    yield "the second configuration", text_of(file_of(other, behind=behind)).encode(), ["--configuration", "2"], d


def lenses():
    folders = ("objectives", "tube_lenses", "illuminators")
    for file in sorted(file for folder in folders for file in (ROOT / "assets" / folder).glob("*.toml")):
        lens = Lens.of(file)
        if lens.media and all(medium == "air" or medium in lens.media for _, _, medium, _ in lens.surfaces):
            if "ideal_focal_length" not in file.read_text() and math.isfinite(lens.focal_lengths(LINES_UM["d"])[0]):
                yield lens
