"""Reads what the field's own programs write, in every variant that they offer, and compares it with what they hold.

    pip install trimesh scipy meshio pyvista nibabel pynrrd SimpleITK pandas
    python tests/writers.py READ [ROUNDS]

READ is the program of examples/read.rs. Triangles are compared corner by corner, label maps by the box around the label:
its middle is where nibabel, pynrrd and SimpleITK read the label's voxels. Fails if a file is read otherwise than it was
written, or refused without being expected to be. ROUNDS damaged files of each format must be refused, or have at least the faces
that trimesh, meshio or VTK find.
"""

import contextlib
import gzip
import itertools
import json
import multiprocessing
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import meshio
import nibabel
import nrrd
import numpy as np
import pandas
import pyvista
import SimpleITK as sitk
import trimesh
import vtk

READ = sys.argv[1]
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 100
FOLDER = Path(tempfile.mkdtemp())
failed, count = [], 0


def ask(*arguments):
    done = subprocess.run([READ, *map(str, arguments)], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def check(name, is_right, answer):
    global count
    count += 1
    if not is_right:
        failed.append(name)
        print(f"{name}: {answer.get('error', 'is read otherwise than it was written')}")


def path(name):
    """A file of its own for each variant."""
    folder = FOLDER / str(count)
    folder.mkdir(exist_ok=True)
    return folder / name


# --- Surfaces

ROUND = trimesh.creation.icosphere(subdivisions=2, radius=7.25)
ROUND.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 2], [3, 0, 1]))
ROUND.apply_translation([11.5, -3.25, 40.125])


def is_same(answer, vertices=ROUND.vertices, faces=ROUND.faces):
    """The same triangles with the same turns: each vertex is a written one, within single precision."""
    if "error" in answer or len(answer["triangles"]) != len(faces):
        return False
    far = np.linalg.norm(np.array(answer["vertices"])[:, None] - np.asarray(vertices)[None], axis=2)
    if far.min(axis=1).max() > 1e-5:
        return False
    read = far.argmin(axis=1)[np.array(answer["triangles"])]
    turned = lambda t: min(tuple(np.roll(t, k)) for k in range(3))
    return sorted(map(turned, read)) == sorted(map(turned, np.asarray(faces)))


def check_surface(name, file):
    answer = ask(file)
    check(name, is_same(answer), answer)


def surfaces():
    for kind, options in [
        ("stl", {}), ("stl_ascii", {}), ("obj", {}), ("ply", {"encoding": "ascii"}), ("ply", {"encoding": "binary"}),
        ("ply", {"vertex_normal": True}), ("obj", {"include_normals": True, "digits": 12}),
    ]:
        file = path("a." + kind.split("_")[0])
        file.write_bytes(data.encode() if isinstance(data := ROUND.export(file_type=kind, **options), str) else data)
        check_surface(f"trimesh {kind} {options}", file)
    mesh = meshio.Mesh(ROUND.vertices, [("triangle", ROUND.faces)])
    for kind, form, options in [
        ("stl", "stl", {"binary": False}), ("stl", "stl", {"binary": True}), ("obj", "obj", {}),
        ("ply", "ply", {"binary": False}), ("ply", "ply", {"binary": True}),
        ("vtk", "vtk42", {"binary": False}), ("vtk", "vtk42", {"binary": True}),
        ("vtk", "vtk51", {"binary": False}), ("vtk", "vtk51", {"binary": True}),
    ]:
        file = path("a." + kind)
        meshio.write(file, mesh, file_format=form, **options)
        check_surface(f"meshio {form} {options}", file)
    data = pyvista.wrap(ROUND)
    data.field_data["note"] = ["two words", "and more"]
    data.field_data["time"] = [0.5]
    data.point_data["ids"] = np.arange(data.n_points)
    for kind, binary in itertools.product(["stl", "ply", "vtk", "vtp"], [True, False]):
        file = path("a." + kind)
        data.save(file, binary=binary)
        check_surface(f"pyvista {kind} binary={binary}", file)
    strips = data.strip()
    for kind, version in [("vtk", 42), ("vtk", 51), ("vtp", 0)]:
        file = path("a." + kind)
        write_vtk(strips, file, version, False)
        check_surface(f"VTK strips {kind} {version}", file)
    # A polygon that is not convex.
    hook = np.array([[4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 4, 0], [0, 4, 0], [0, 0, 0]], dtype=float)
    polygon = pyvista.PolyData(hook, faces=[6, *range(6)])
    for kind in ["vtk", "vtp", "ply", "obj"]:
        file = path("a." + kind)
        if kind == "obj":
            meshio.write(file, meshio.Mesh(hook, [("polygon", np.arange(6)[None])]))
        else:
            polygon.save(file)
        answer = ask(file)
        area = trimesh.Trimesh(answer.get("vertices", []), answer.get("triangles", []), process=False).area
        check(f"concave {kind}", abs(area - 7) < 1e-6, answer)


# --- Lines

LINE = np.array([[0, 0, 0], [0, 0, 10], [1, 0, 20], [3, 0, 29], [4, 1, 35]], dtype=float)


def write_vtk(data, file, version, binary, compressor=None, mode=None, header=None):
    if file.suffix == ".vtk":
        writer = vtk.vtkPolyDataWriter()
        writer.SetFileVersion(version)
        writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
    else:
        writer = vtk.vtkXMLPolyDataWriter()
        getattr(writer, f"SetDataModeTo{mode or 'Ascii'}")()
        getattr(writer, f"SetCompressorTypeTo{compressor or 'None'}")()
        if header:
            getattr(writer, f"SetHeaderTypeTo{header}")()
    writer.SetInputData(data)
    writer.SetFileName(str(file))
    writer.Write()


def check_line(name, file, refused=None, radii=None, expected=LINE):
    answer = ask("--line", file)
    if refused:
        return check(name, refused in answer.get("error", ""), answer)
    is_right = "error" not in answer and np.shape(answer["points"]) == LINE.shape
    is_right = is_right and np.allclose(answer["points"], expected, rtol=1e-5, atol=1e-6)
    check(name, is_right and answer["radii"] == radii, answer)


def lines():
    whole, cut = pyvista.MultipleLines(LINE), pyvista.lines_from_points(LINE)
    shuffled = pyvista.PolyData(LINE, lines=[2, 0, 1, 2, 2, 3, 2, 2, 1, 2, 4, 3])
    repeated = pyvista.lines_from_points(np.repeat(LINE, [1, 2, 1, 3, 1], axis=0))
    doubled = pyvista.PolyData(LINE, lines=[2, 0, 1, 2, 1, 0, 2, 1, 2, 2, 1, 2, 2, 2, 3, 2, 4, 3])
    # Cells with points of their own, which differ by rounding; and every second one turned there and back by VTK.
    draws = np.random.default_rng(5)
    ends = np.repeat(LINE, 2, axis=0)[1:-1]
    own = pyvista.line_segments_from_points(ends + draws.uniform(-1e-12, 1e-12, ends.shape))
    parts = [pyvista.line_segments_from_points(pair.astype(np.float32)) for pair in ends.reshape(4, 2, 3) + 50]
    turn = lambda part: part.rotate_vector((1, 2, 2), 70).rotate_vector((1, 2, 2), 60).rotate_vector((1, 2, 2), -130)
    turned = parts[0].append_polydata(turn(parts[1]), parts[2], turn(parts[3]))
    for title, data in [
        ("one cell", whole), ("cells of two", cut), ("in any order", shuffled), ("repeated points", repeated),
        ("repeated cells", doubled), ("points of each cell", own), ("turned there and back", turned),
    ]:
        data = data.copy()
        expected = LINE + 50 if title == "turned there and back" else LINE
        data.point_data["MaximumInscribedSphereRadius"] = np.arange(float(data.n_points))
        data.point_data["normals"] = np.ones((data.n_points, 3))
        data.field_data["note"] = ["two words"]
        for version, binary in itertools.product([42, 51], [True, False]):
            file = path("a.vtk")
            write_vtk(data, file, version, binary)
            check_line(f"{title} vtk {version} binary={binary}", file, expected=expected)
        for mode, compressor, header in itertools.product(
            ["Ascii", "Binary", "Appended"], ["None", "ZLib", "LZ4", "LZMA"], ["UInt32", "UInt64"]
        ):
            file = path("a.vtp")
            write_vtk(data, file, 0, True, compressor, mode, header)
            refused = f"packed by {compressor}" if compressor in ["LZ4", "LZMA"] else None
            check_line(f"{title} vtp {mode} {compressor} {header}", file, refused, expected=expected)


def tables():
    table = pandas.DataFrame(LINE, columns=["x", "y", "z"])
    radii = [1.5] * 4
    for title, data, options, own in [
        ("plain", table, {"index": False}, None), ("index", table, {}, None),
        ("named index", table, {"index_label": "id"}, None), ("tabs", table, {"sep": "\t", "index": False}, None),
        ("decimal commas", table, {"sep": ";", "decimal": ",", "index": False}, None),
        ("no heading", table, {"header": False, "index": False}, None),
        ("UTF-16", table, {"encoding": "utf-16"}, None), ("UTF-8 with a mark", table, {"encoding": "utf-8-sig"}, None),
        ("quotes", table, {"quoting": 1, "index": False}, None), ("carriage returns", table, {"lineterminator": "\r"}, None),
        ("radius", table.assign(radius=1.5), {}, radii), ("diameter", table.assign(Diameter=3.0), {}, radii),
        ("VMTK", table.assign(MaximumInscribedSphereRadius=1.5, Abscissas=7), {"index": False}, None),
        ("ParaView", table.set_axis([f"Points:{axis}" for axis in range(3)], axis=1), {}, None),
        ("ParaView, renamed", table.set_axis([f"Points_{axis}" for axis in range(3)], axis=1), {}, None),
    ]:
        file = path("a.csv")
        data.to_csv(file, **options)
        check_line(f"pandas {title}", file, radii=own)
    for delimiter in [" ", ",", ";", "\t"]:
        file = path("a.txt")
        np.savetxt(file, LINE, delimiter=delimiter, header="x y z")
        check_line(f"numpy {delimiter!r}", file)


# --- Label maps

BLOCK = np.zeros((8, 6, 10), dtype=np.uint8)
BLOCK[2:5, 1:4, 5:8] = 3
BLOCK[7, 5, 9] = 1


def box(corner_to_place):
    """The box of the block's voxels, wherever the program says they are; a surface passes half a voxel outside."""
    return np.array([corner_to_place(np.array(corner)) for corner in itertools.product((2, 4), (1, 3), (5, 7))])


def check_map(name, file, places, frame, refused=None, label=3, options=()):
    answer = ask(*options, f"{file}:{label}")
    if refused:
        return check(name, refused in answer.get("error", ""), answer)
    if "error" in answer:
        return check(name, False, answer)
    middle = np.mean(answer["vertices"], axis=0)
    is_right = np.allclose(middle, places.mean(axis=0), atol=1e-3) and answer["frame"] == frame
    # Each vertex is near the block.
    steps = np.linalg.norm(places - places.mean(axis=0), axis=1).max()
    far = np.linalg.norm(np.array(answer["vertices"]) - places.mean(axis=0), axis=1).max()
    check(name, is_right and far < 2 * steps, answer)


def turned(mirror=1.0):
    turn = trimesh.transformations.rotation_matrix(0.6, [1, 2, 2])[:3, :3]
    affine = np.eye(4)
    affine[:3, :3] = turn @ np.diag([2.0, 3.0, 4.0 * mirror])
    affine[:3, 3] = [10, 20, 30]
    return affine


def edit(file, at, data):
    """Replaces bytes of a header; nibabel writes its own affine into a form that does not fit."""
    whole = bytearray(gzip.decompress(file.read_bytes()) if file.suffix == ".gz" else file.read_bytes())
    whole[at:at + len(data)] = data
    file.write_bytes(gzip.compress(whole) if file.suffix == ".gz" else whole)


def label_maps():
    for klass, dtype, mirror, form, order in itertools.product(
        [nibabel.Nifti1Image, nibabel.Nifti2Image, nibabel.Nifti1Pair, nibabel.Nifti2Pair],
        [np.uint8, np.int16, np.int32, np.float32, np.float64], [1.0, -1.0], ["s", "q", "both", "zero s"], "<>",
    ):
        header = klass.header_class(endianness=order)
        image = klass(BLOCK.astype(dtype), turned(mirror), header)
        image.set_data_dtype(np.dtype(dtype).newbyteorder(order))
        image.set_sform(turned(mirror), code=0 if form == "q" else 1)
        image.set_qform(turned(mirror), code=0 if form == "s" else 1)
        file = path("a.img" if "Pair" in klass.__name__ else "a.nii.gz" if dtype == np.uint8 else "a.nii")
        image.to_filename(file)
        if form == "zero s":
            at, size = (280, 48) if "1" in klass.__name__ else (400, 96)
            edit(file.with_suffix(".hdr") if file.suffix == ".img" else file, at, bytes(size))
        affine = turned(mirror)
        check_map(f"nibabel {klass.__name__} {dtype.__name__} {mirror} {form} {order}", file,
                  box(lambda voxel: affine[:3, :3] @ voxel + affine[:3, 3]), "Ras")
    # Labels that a writer scales to fill its type.
    for dtype in [np.uint8, np.int16, np.uint16]:
        image = nibabel.Nifti1Image(BLOCK.astype(float), turned())
        image.set_data_dtype(dtype)
        file = path("a.nii")
        image.to_filename(file)
        affine = turned()
        check_map(f"nibabel scaled {dtype.__name__}", file, box(lambda v: affine[:3, :3] @ v + affine[:3, 3]), "Ras")

    # A slope of nearly 1 and high labels.
    for dtype, label, slope in itertools.product([np.uint16, np.int32], [200, 30000], [0.99999, 1.00001]):
        image = nibabel.Nifti1Image(BLOCK.astype(dtype) // 3 * dtype(label), turned())
        file = path("a.nii")
        image.to_filename(file)
        edit(file, 112, np.float32(slope).tobytes())
        assert round(nibabel.load(file).get_fdata().max() / slope) == label
        affine = turned()
        check_map(f"nibabel label {label} slope {slope}", file, box(lambda v: affine[:3, :3] @ v + affine[:3, 3]), "Ras",
                  label=label)

    # A form of zeros alone: nibabel's affine is 0, SimpleITK refuses it.
    image = nibabel.Nifti1Image(BLOCK, turned())
    image.set_sform(turned(), code=1)
    image.set_qform(None, code=0)
    file = path("a.nii")
    image.to_filename(file)
    edit(file, 280, bytes(48))
    check_map("zero sform alone", file, None, None, "its sform is zero and its qform unknown")
    spacing = np.array(nibabel.load(file).header.get_zooms())
    check_map("zero sform alone, allowed", file, box(lambda v: spacing * v), None, options=["--no-position"])

    # Two forms that differ: nibabel takes the sform, and SimpleITK the one that is named.
    for s, q, shift in itertools.product([1, 2, 4], [1, 2], [0.0, 3.0]):
        image = nibabel.Nifti1Image(BLOCK, turned())
        image.set_sform(turned(), code=s)
        other = turned()
        other[:3, 3] += shift
        image.set_qform(other, code=q)
        file = path("a.nii")
        image.to_filename(file)
        affine = nibabel.load(file).affine
        assert np.allclose(affine, turned(), atol=1e-4)
        name = f"forms {s} {q} {shift}"
        check_map(name, file, box(lambda v: affine[:3, :3] @ v + affine[:3, 3]), "Ras")
        answer = ask(f"{file}:3")
        origin = np.array(sitk.ReadImage(str(file)).GetOrigin()) * [-1, -1, 1]
        takes = "nibabel and ITK do" if np.allclose(origin, turned()[:3, 3], atol=1e-3) else "ITK and 3D Slicer take the qform"
        doubts = answer.get("doubts", [])
        check(name + " doubt", takes in doubts[0] if shift and doubts else not shift and not doubts, answer)

    # nibabel and SimpleITK read a negative spacing differently.
    for form in ["s", "q"]:
        image = nibabel.Nifti1Image(BLOCK, turned())
        image.set_sform(turned(), code=int(form == "s"))
        image.set_qform(turned(), code=int(form == "q"))
        file = path("a.nii")
        image.to_filename(file)
        edit(file, 80, np.float32(-2).tobytes())
        check_map(f"negative pixdim {form}", file, None, None, "pixdim[1] is -2")

    for space, encoding, dtype, apart in itertools.product(
        ["left-posterior-superior", "right-anterior-superior"], ["raw", "gzip", "ascii", "bzip2"],
        [np.uint8, np.int16, np.uint32, np.float32], [False, True],
    ):
        affine = turned()
        header = {"space": space, "space directions": affine[:3, :3].T, "space origin": affine[:3, 3],
                  "encoding": encoding, "kinds": ["domain"] * 3}
        file = path("a.nhdr" if apart else "a.nrrd")
        nrrd.write(str(file), BLOCK.astype(dtype), header, detached_header=apart)
        _, read = nrrd.read(str(file))
        check_map(f"pynrrd {space} {encoding} {dtype.__name__} apart={apart}", file,
                  box(lambda v: read["space directions"].T @ v + read["space origin"]),
                  "Lps" if space.startswith("left") else "Ras", "'bzip2'" if encoding == "bzip2" else None)
    file = path("a.nrrd")
    nrrd.write(str(file), BLOCK, {"spacings": [2.0, 3.0, 4.0]})
    check_map("pynrrd spacings", file, None, None, "does not say where its voxels are")
    file = path("a.nrrd")
    nrrd.write(str(file), np.stack([BLOCK, BLOCK]), {
        "space": "left-posterior-superior", "space origin": [0, 0, 0], "kinds": ["list"] + ["domain"] * 3,
        "space directions": np.vstack([[np.nan] * 3, np.eye(3)])})
    check_map("pynrrd layers", file, None, None, "holds 2 layers")

    for kind, pixel, packed, mirror in itertools.product(
        ["nii", "nii.gz", "hdr", "nrrd", "nhdr", "mha", "mhd"],
        [sitk.sitkUInt8, sitk.sitkInt16, sitk.sitkUInt16, sitk.sitkInt32, sitk.sitkFloat32, sitk.sitkUInt64],
        [True, False], [1.0, -1.0],
    ):
        affine = turned(mirror)
        image = sitk.Cast(sitk.GetImageFromArray(BLOCK.transpose(2, 1, 0)), pixel)
        image.SetSpacing([2.0, 3.0, 4.0])
        image.SetOrigin(affine[:3, 3])
        image.SetDirection((affine[:3, :3] / [2.0, 3.0, 4.0]).ravel())
        file = path("a b." + kind if kind == "mhd" else "a." + kind)
        try:
            sitk.WriteImage(image, str(file), useCompression=packed)
        except RuntimeError:
            continue  # Not in this format.
        read = sitk.ReadImage(str(file))
        is_ras = kind.split(".")[0] in ["nii", "hdr"]
        flip = np.array([-1.0, -1.0, 1.0]) if is_ras else np.ones(3)
        place = lambda v: np.array(read.TransformContinuousIndexToPhysicalPoint(v.astype(float).tolist())) * flip
        check_map(f"SimpleITK {kind} {image.GetPixelIDTypeAsString()} packed={packed} {mirror}", file, box(place),
                  "Ras" if is_ras else "Lps")

    # Headers of MetaImage that SimpleITK reads without a word, and names that it does not find.
    image = sitk.GetImageFromArray(BLOCK.transpose(2, 1, 0))
    image.SetSpacing([2.0, 3.0, 4.0])
    image.SetOrigin([10.0, 20.0, 30.0])
    for field, other, refused in [
        ("Offset", "", "no field 'Offset'"), ("ElementSpacing", "", "no field 'ElementSpacing'"),
        ("Offset", "Position = 1 2 3", None), ("ElementSpacing", "ElementSize = 1 2 3", None),
        ("TransformMatrix", "", None), ("CenterOfRotation", "DistanceUnits = mm", None),
    ]:
        file = path("a.mha")
        sitk.WriteImage(image, str(file), useCompression=False)
        head, data = file.read_bytes().split(b"ElementDataFile", 1)
        fields = [other if line.startswith(field) else line for line in head.decode().splitlines()]
        head = "".join(line + "\n" for line in fields if line)
        file.write_bytes(head.encode() + b"ElementDataFile" + data)
        read = sitk.ReadImage(str(file))
        places = box(lambda v: np.array(read.TransformContinuousIndexToPhysicalPoint(v.astype(float).tolist())))
        check_map(f"MetaImage {field} {other!r}", file, places, "Lps", refused)
        if refused:
            check_map(f"MetaImage {field} allowed", file, places, "Lps", options=["--no-position"])
    for name in ["./a.raw", ".\\a.raw", '"a.raw"', "LIST", "a%d.raw 1 2 1"]:
        file = path("a.mhd")
        sitk.WriteImage(image, str(file), useCompression=False)
        file.write_text(file.read_text().replace("= a.raw", f"= {name}"))
        refused = "several files" if name[-1] in "T1" else None
        check_map(f"MetaImage {name}", file, box(lambda v: [2, 3, 4] * v + [10, 20, 30]), "Lps", refused)


# --- Damaged surfaces


def damaged(whole, draws):
    """One to four changes: a bit, a byte, an end, a line that is lost, twice, or elsewhere, another end of a line, a digit."""
    data = bytearray(whole)
    for _ in range(draws.integers(1, 5)):
        at, kind = int(draws.integers(len(data))), draws.integers(7)
        if kind == 0:
            data[at] ^= 1 << int(draws.integers(8))
        elif kind == 1:
            data[at] = int(draws.integers(256))
        elif kind == 2:
            del data[at + 1:]
        elif kind == 3:
            ends = [place for place, byte in enumerate(data) if byte == 10]
            if ends:
                data[draws.choice(ends)] = 13
        elif kind == 4:
            digits = [place for place, byte in enumerate(data) if 48 <= byte < 58]
            if digits:
                data[draws.choice(digits)] = int(draws.integers(48, 58))
        else:
            rows = data.split(b"\n")
            a, b = draws.integers(len(rows), size=2)
            if kind == 5:
                rows[a], rows[b] = rows[b], rows[a]
            else:
                rows[a:a + int(draws.integers(2))] = [rows[b]] * int(draws.integers(2))
            data = bytearray(b"\n".join(rows)) or bytearray(b"\n")
    return bytes(data)


def faces_of(file):
    """The most triangles with three different corners that another reader finds."""
    vtk.vtkObject.GlobalWarningDisplayOff()
    readers = {
        "trimesh": lambda: trimesh.load(file, process=False, force="mesh").faces,
        "meshio": lambda: [face for block in meshio.read(file).cells if block.type in ("triangle", "quad", "polygon")
                           for face in block.data],
        "vtk": lambda: pyvista.read(file).extract_surface().triangulate().faces.reshape(-1, 4)[:, 1:],
    }
    # VTK takes damaged text for a binary file, and counts triangles by the file's length.
    whole = file.read_bytes()
    if file.suffix == ".stl" and whole.startswith(b"solid") and b"\0" not in whole:
        del readers["vtk"]
    most, finder = 0, ""
    for name, reader in readers.items():
        try:
            with contextlib.redirect_stdout(None), contextlib.redirect_stderr(None):
                found = sum(len(set(np.asarray(face).tolist())) - 2 for face in reader() if len(set(np.asarray(face).tolist())) > 2)
        except BaseException as error:  # What a reader raises for a damaged file is of any kind.
            if isinstance(error, KeyboardInterrupt):
                raise
            continue
        if found > most:
            most, finder = found, name
    return most, finder


def damaged_surfaces():
    # In a process of its own, because damaged files break VTK.
    pool = ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork"))
    small = trimesh.creation.icosphere(subdivisions=1, radius=7.25)
    data = pyvista.wrap(small)
    data.point_data["ids"] = np.arange(data.n_points)
    wholes = []
    for kind, binary in itertools.product(["stl", "ply", "vtk", "vtp"], [False, True]):
        file = path("a." + kind)
        data.save(file, binary=binary)
        wholes.append((kind, file.read_bytes()))
    wholes.append(("obj", small.export(file_type="obj").encode()))
    draws = np.random.default_rng(66)
    for number, (kind, whole) in enumerate(wholes):
        folder = FOLDER / f"damaged{number}"
        folder.mkdir()
        files = [folder / f"{k}.{kind}" for k in range(ROUNDS)]
        for file in files:
            file.write_bytes(damaged(whole, draws))
        read = 0
        for start in range(0, ROUNDS, 100):
            some = files[start:start + 100]
            done = subprocess.run([READ, *map(str, some)], capture_output=True, text=True, check=True)
            for file, line in zip(some, done.stdout.splitlines(), strict=True):
                answer = json.loads(line)
                if "error" in answer:
                    continue
                read += 1
                try:
                    most, finder = pool.submit(faces_of, file).result()
                except BrokenProcessPool:
                    pool = ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("fork"))
                    continue
                own = len(answer["triangles"]) + answer["skipped"]
                check(f"{file}: {finder} finds {most} faces, not {own}", own >= most, answer)
        print(f"{kind}: {read} of {ROUNDS} damaged files are read")


surfaces()
lines()
tables()
label_maps()
damaged_surfaces()
print(f"{count} files, {len(failed)} read otherwise")
sys.exit(bool(failed))
