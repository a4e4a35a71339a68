#!/usr/bin/env python3
"""An IGES, BREP or STEP file -> a perpend model (RON), through Open CASCADE.

    pip install cadquery-ocp
    python to_perpend.py part.iges part.ron

Every face becomes a trimmed surface: its carrier as NURBS, its p-curves as Open CASCADE has them, in millimetres. STEP files have a reader of
perpend's own (`perpend import`), which also knows the analytic classes; this is the way for the formats that it does not read.
Exit code 1 where a face could not be converted; it is named, and the others are written.
"""
import sys

from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
from OCP.BRepTools import BRepTools, BRepTools_WireExplorer
from OCP.Geom2dConvert import Geom2dConvert
from OCP.Geom2d import Geom2d_TrimmedCurve
from OCP.GeomConvert import GeomConvert
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.ShapeFix import ShapeFix_Shape
from OCP.TopAbs import TopAbs_Orientation, TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape


def read(path):
    kind = path.rsplit(".", 1)[-1].lower()
    if kind == "brep":
        from OCP.BRep import BRep_Builder

        shape = TopoDS_Shape()
        if not BRepTools.Read_s(shape, path, BRep_Builder()):
            sys.exit(f"{path}: Open CASCADE cannot read it as BREP")
        return shape
    if kind in ("igs", "iges"):
        from OCP.IGESControl import IGESControl_Reader as Reader
    elif kind in ("stp", "step"):
        from OCP.STEPControl import STEPControl_Reader as Reader
    else:
        sys.exit(f"{path}: its name ends in none of .iges .igs .brep .step .stp")
    reader = Reader()
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        sys.exit(f"{path}: Open CASCADE cannot read it")
    reader.TransferRoots()
    return reader.OneShape()


def explore(shape, kind):
    explorer = TopExp_Explorer(shape, kind)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


# static methods have a trailing underscore in the bindings of Open CASCADE 7, and none in those of 8
as_face = getattr(TopoDS, "Face_s", None) or TopoDS.Face
as_wire = getattr(TopoDS, "Wire_s", None) or TopoDS.Wire


def number(x):
    text = repr(float(x))
    return text if any(c in text for c in ".en") else text + ".0"


def numbers(values):
    return "[" + ", ".join(map(number, values)) + "]"


def point(values):
    return "(" + ", ".join(map(number, values)) + ")"


def flat_knots(knots, multiplicities):
    return [knot for knot, count in zip(knots, multiplicities) for _ in range(count)]


def surface(carrier):
    """The RON of a B-spline surface."""
    if carrier.IsUPeriodic():
        carrier.SetUNotPeriodic()
    if carrier.IsVPeriodic():
        carrier.SetVNotPeriodic()
    rows, columns = carrier.NbUPoles(), carrier.NbVPoles()
    knots_u = flat_knots(*[[get(i) for i in range(1, carrier.NbUKnots() + 1)] for get in (carrier.UKnot, carrier.UMultiplicity)])
    knots_v = flat_knots(*[[get(i) for i in range(1, carrier.NbVKnots() + 1)] for get in (carrier.VKnot, carrier.VMultiplicity)])
    grid = [[carrier.Pole(i, j) for j in range(1, columns + 1)] for i in range(1, rows + 1)]
    points = ",\n".join("[" + ", ".join(point((p.X(), p.Y(), p.Z())) for p in row) + "]" for row in grid)
    weights = "None"
    if carrier.IsURational() or carrier.IsVRational():
        values = [[carrier.Weight(i, j) for j in range(1, columns + 1)] for i in range(1, rows + 1)]
        weights = "Some([" + ",\n".join(map(numbers, values)) + "])"
    return (
        f"NurbsSurface(degree: ({carrier.UDegree()}, {carrier.VDegree()}), knots: ({numbers(knots_u)}, {numbers(knots_v)}),\n"
        f"control_points: [{points}],\nweights: {weights})"
    )


def p_curve(edge, face):
    """The RON of an edge's p-curve on a face, run through as the loop runs; none where there is none."""
    curve = BRep_Tool.CurveOnSurface_s(edge, face, 0.0, 0.0)
    if curve is None:
        return None
    first, last = BRep_Tool.Range_s(edge, face)
    spline = Geom2dConvert.CurveToBSplineCurve_s(Geom2d_TrimmedCurve(curve, first, last))
    if edge.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
        spline.Reverse()
    if spline.IsPeriodic():
        spline.SetNotPeriodic()
    knots = flat_knots(*[[get(i) for i in range(1, spline.NbKnots() + 1)] for get in (spline.Knot, spline.Multiplicity)])
    poles = [spline.Pole(i) for i in range(1, spline.NbPoles() + 1)]
    points = "[" + ", ".join(point((p.X(), p.Y())) for p in poles) + "]"
    weights = "None"
    if spline.IsRational():
        weights = "Some(" + numbers(spline.Weight(i) for i in range(1, spline.NbPoles() + 1)) + ")"
    return f"(degree: {spline.Degree()}, knots: {numbers(knots)}, points: {points}, weights: {weights})"


def loop(wire, face, outer):
    curves, edges = [], BRepTools_WireExplorer(wire, face)
    tolerance = 0.0
    while edges.More():
        curve = p_curve(edges.Current(), face)
        if curve is None:
            raise ValueError("an edge has no p-curve")
        tolerance = max(tolerance, BRep_Tool.Tolerance_s(edges.Current()), BRep_Tool.Tolerance_s(edges.CurrentVertex()))
        curves.append(curve)
        edges.Next()
    if not curves:
        raise ValueError("a loop has no edges")
    joined = ",\n".join(curves)
    return f"(outer: {'true' if outer else 'false'}, curves: [{joined}])", tolerance


def trimmed(face):
    """The RON of a face."""
    reversed_ = face.Orientation() == TopAbs_Orientation.TopAbs_REVERSED
    # loops are read off the face as its surface sees it
    forward = as_face(face.Oriented(TopAbs_Orientation.TopAbs_FORWARD))
    carrier = GeomConvert.SurfaceToBSplineSurface_s(BRep_Tool.Surface_s(forward))
    outer = BRepTools.OuterWire_s(forward)
    loops, tolerance = [], BRep_Tool.Tolerance_s(forward)
    for wire in explore(forward, TopAbs_ShapeEnum.TopAbs_WIRE):
        text, gap = loop(as_wire(wire), forward, wire.IsSame(outer))
        loops.append(text)
        tolerance = max(tolerance, 2.0 * gap)
    joined = ",\n".join(loops)
    return (
        f"TrimmedSurface(surface: Own({surface(carrier)}),\nreversed: {'true' if reversed_ else 'false'}, "
        f"tolerance: {number(tolerance)},\nloops: [{joined}])"
    )


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    source, target = sys.argv[1:]
    shape = read(source)
    fixer = ShapeFix_Shape(shape)
    fixer.Perform()
    shape = BRepBuilderAPI_NurbsConvert(fixer.Shape(), True).Shape()
    entities, failed = [], 0
    faces = list(explore(shape, TopAbs_ShapeEnum.TopAbs_FACE))
    for index, face in enumerate(faces, start=1):
        try:
            entities.append(f'(id: {index}, name: "face {index}", definition: {trimmed(as_face(face))})')
        except Exception as problem:  # whatever Open CASCADE does: the face is named, and the others are written
            failed += 1
            print(f"{source}: face {index}: {problem}", file=sys.stderr)
    with open(target, "w", encoding="utf-8") as out:
        out.write("Model(format: 1, units: Millimetre, entities: [\n" + ",\n".join(entities) + "\n])\n")
    print(f"{target}: {len(entities)} of {len(faces)} faces", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
