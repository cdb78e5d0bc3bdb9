"""Opens the snapshots of a run in ParaView, coloured by body, with what stands behind its planes of
symmetry.

In ParaView: Macros > Import new macro, or View > Python Shell > Run Script. Without a window:
pvpython open_in_paraview.py PICTURE.png draws the last snapshot.
"""

import json
import os
import sys

TITLE = @TITLE@
# Below the folder of this script, if it has not been moved.
SNAPSHOTS = @SNAPSHOTS@
PLACE = @PLACE@
BODIES = @BODIES@
# Colours of the bodies (red, green, blue), those of `whipple plot`.
COLOURS = @COLOURS@
# Radius of a particle (m).
RADIUS = @RADIUS@
# Planes of symmetry: the number of the axis normal to each, and where it cuts that axis (m).
PLANES = @PLANES@


def snapshots():
    """Path of the snapshots: beside the script, or where they were when it was written."""
    here = os.path.dirname(os.path.abspath(globals().get("__file__", "")))
    beside = os.path.join(here, SNAPSHOTS)
    return beside if os.path.exists(beside) else PLACE


def opened(simple, path):
    """The source of the snapshots. ParaView 5.11 reads them, but does not know the endings of their names."""
    try:
        return simple.OpenDataFile(path)
    except RuntimeError:
        names = [path]
    if path.endswith(".series"):
        with open(path, encoding="utf-8") as index:
            files = json.load(index)["files"]
        names = [os.path.join(os.path.dirname(path), file["name"]) for file in files]
    return simple.VTKHDFReader(FileName=names)


def mirrored(simple, source, axis, position):
    """A source with its image behind a plane; vectors and tensors are reflected, too."""
    origin, normal = [0.0] * 3, [0.0] * 3
    origin[axis], normal[axis] = position, 1.0
    # Newer versions of ParaView have another filter, with other names.
    make = getattr(simple, "AxisAlignedReflect", None) or simple.Reflect
    image = make(Input=source)
    known = image.ListProperties()
    image.CopyInput = 1
    if "ReflectionPlane" in known:
        image.ReflectionPlane.Origin = origin
        image.ReflectionPlane.Normal = normal
        image.ReflectAllInputArrays = 1
    else:
        image.Plane = "XYZ"[axis]
        image.Center = position
        image.FlipAllInputArrays = 1
    return image


def main(picture=None):
    """Shows the snapshots; draws the last into a file if there is a name for it."""
    from paraview import simple

    source = opened(simple, snapshots())
    simple.RenameSource(TITLE, source)
    for axis, position in PLANES:
        source = mirrored(simple, source, axis, position)
    view = simple.GetActiveViewOrCreate("RenderView")
    shown = simple.Show(source, view)
    shown.SetRepresentationType("Point Gaussian")
    shown.GaussianRadius = RADIUS
    simple.ColorBy(shown, ("POINTS", "body"))
    colours = simple.GetColorTransferFunction("body")
    colours.InterpretValuesAsCategories = 1
    colours.Annotations = [text for k, name in enumerate(BODIES) for text in (str(k), name)]
    colours.IndexedColors = [share / 255.0 for colour in COLOURS for share in colour]
    shown.SetScalarBarVisibility(view, True)
    simple.GetAnimationScene().GoToLast()
    lower, upper = source.GetDataInformation().GetBounds()[4:]
    if upper > lower:
        view.CameraPosition, view.CameraFocalPoint = [1.0, -2.0, 1.0], [0.0] * 3
        view.CameraViewUp = [0.0, 0.0, 1.0]
    simple.ResetCamera(view)
    simple.Render(view)
    if picture:
        simple.SaveScreenshot(picture, view, ImageResolution=[1200, 900])


if __name__ in ("__main__", "__vtkconsole__"):
    main(*sys.argv[1:2])
