"""Other libraries at the same work, one request a line: `name number` is answered by one line of JSON."""

import json
import sys
import time
from pathlib import Path

import numpy as np

ROUNDS_BEFORE = 2
# Drawings of a turn, of which the median counts.
DRAWINGS = 5


def timed(work, times=1):
    took = []
    for _ in range(times):
        start = time.perf_counter()
        answer = work()
        took.append((time.perf_counter() - start) * 1000.0)
    return {"ms": float(np.median(took)), "answer": answer}


def nearest(distances):
    best = int(np.argmin(distances))
    return [best, int(distances[best])]


class Searches:
    def __init__(self, folder):
        self.views = np.fromfile(folder / "views.bin", dtype=np.uint8).reshape(-1, 8192)
        self.queries = np.fromfile(folder / "queries.bin", dtype=np.uint8).reshape(-1, 8192)

    def faiss(self):
        import faiss

        faiss.omp_set_num_threads(1)
        index = faiss.IndexBinaryFlat(8 * self.views.shape[1])
        index.add(self.views)

        def search(query):
            distances, views = index.search(query[None], 1)
            return [int(views[0, 0]), int(distances[0, 0])]

        return lambda number: timed(lambda: search(self.queries[number]))

    def usearch(self):
        from usearch.index import MetricKind, search

        def exact(query):
            found = search(self.views, query, 1, MetricKind.Hamming, exact=True, threads=1)
            return [int(found.keys[0]), int(found.distances[0])]

        return lambda number: timed(lambda: exact(self.queries[number]))

    def opencv(self):
        import cv2

        cv2.setNumThreads(1)

        def match(query):
            kind = cv2.NORM_HAMMING
            distances, views = cv2.batchDistance(query[None], self.views, cv2.CV_32S, normType=kind, K=1)
            return [int(views[0, 0]), int(distances[0, 0])]

        return lambda number: timed(lambda: match(self.queries[number]))

    def numpy(self):
        words = self.views.view(np.uint64)

        def match(query):
            return nearest(np.bitwise_count(words ^ query.view(np.uint64)[None]).sum(axis=1, dtype=np.int64))

        return lambda number: timed(lambda: match(self.queries[number]))


class Silhouettes:
    """Draws the model at a pose into a square frame; the answer is the file that holds the pixels, a byte each."""

    def __init__(self, folder):
        self.folder = folder
        scene = json.loads((folder / "scene.json").read_text())
        self.side, self.focal = scene["side"], scene["focal"]
        self.poses = [np.array(pose).reshape(3, 4) for pose in scene["poses"]]
        self.vertices = np.fromfile(folder / "vertices.bin", dtype=np.float32).reshape(-1, 3)
        self.triangles = np.fromfile(folder / "triangles.bin", dtype=np.uint32).reshape(-1, 3)

    def keep(self, name, number, pixels):
        path = self.folder / f"{name}-{number}.bin"
        (np.asarray(pixels) > 0).astype(np.uint8).tofile(path)
        return str(path)

    def drawn_triangles(self):
        import cv2

        cv2.setNumThreads(1)

        def draw(pose):
            points = self.vertices @ pose[:, :3].T + pose[:, 3]
            scale = self.focal / -points[:, 2]
            middle = self.side / 2.0
            # This rasteriser counts from pixel centres, in sixteenths of a pixel here.
            columns = middle + points[:, 0] * scale - 0.5
            rows = middle - points[:, 1] * scale - 0.5
            corners = np.rint(16.0 * np.stack([columns, rows], axis=1)).astype(np.int32)[self.triangles]
            frame = np.zeros((self.side, self.side), np.uint8)
            for corner in corners:
                cv2.fillConvexPoly(frame, corner, 255, lineType=cv2.LINE_8, shift=4)
            return frame

        def run(number):
            took = timed(lambda: draw(self.poses[number]), DRAWINGS)
            return {"ms": took["ms"], "answer": self.keep("opencv", number, took["answer"])}

        return run

    def rendered(self):
        import vtk
        from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

        points, cells, surface = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
        points.SetData(numpy_to_vtk(self.vertices.astype(np.float64), deep=True))
        sides = np.hstack([np.full((len(self.triangles), 1), 3), self.triangles]).astype(np.int64)
        cells.SetCells(len(sides), numpy_to_vtkIdTypeArray(sides.ravel(), deep=True))
        surface.SetPoints(points)
        surface.SetPolys(cells)
        mapper, actor = vtk.vtkPolyDataMapper(), vtk.vtkActor()
        mapper.SetInputData(surface)
        actor.SetMapper(mapper)
        actor.GetProperty().LightingOff()
        renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
        renderer.AddActor(actor)
        renderer.SetBackground(0, 0, 0)
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(self.side, self.side)
        window.AddRenderer(renderer)
        camera = renderer.GetActiveCamera()
        camera.SetPosition(0, 0, 0)
        camera.SetFocalPoint(0, 0, -1)
        camera.SetViewUp(0, 1, 0)
        camera.SetViewAngle(np.degrees(2 * np.arctan(self.side / 2 / self.focal)))

        def draw(pose):
            matrix = vtk.vtkMatrix4x4()
            for row in range(3):
                for column in range(4):
                    matrix.SetElement(row, column, pose[row, column])
            actor.SetUserMatrix(matrix)
            renderer.ResetCameraClippingRange()
            window.Render()
            pixels = vtk.vtkUnsignedCharArray()
            window.GetRGBACharPixelData(0, 0, self.side - 1, self.side - 1, 0, pixels)
            return vtk_to_numpy(pixels).reshape(self.side, self.side, 4)[::-1, :, 0]

        def run(number):
            took = timed(lambda: draw(self.poses[number]), DRAWINGS)
            return {"ms": took["ms"], "answer": self.keep("vtk", number, took["answer"])}

        return run


def main():
    folder = Path(sys.argv[1])
    searches, silhouettes = Searches(folder), Silhouettes(folder)
    makers = {
        "faiss": searches.faiss,
        "usearch": searches.usearch,
        "opencv": searches.opencv,
        "numpy": searches.numpy,
        "opencv-triangles": silhouettes.drawn_triangles,
        "vtk": silhouettes.rendered,
    }
    ready = {}
    for line in sys.stdin:
        name, number = line.split()
        try:
            if name not in ready:
                ready[name] = makers[name]()
                for _ in range(ROUNDS_BEFORE):
                    ready[name](int(number))
            answer = ready[name](int(number))
        except Exception as error:  # told to whoever asked
            answer = {"error": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


main()
