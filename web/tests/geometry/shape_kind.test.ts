import { describe, expect, it } from 'vitest';
import { plateFraction, shapeKindOf } from '../../src/geometry/shape_kind';

interface Mesh {
  readonly vertices: Float32Array;
  readonly triangles: Uint32Array;
}

/** Sides that follow each other around a closed profile, pulled out along x, with both ends closed by a fan. */
function pulled(profile: readonly (readonly [number, number])[], length: number): Mesh {
  const count = profile.length;
  const vertices = [0, length].flatMap((x) => profile.flatMap(([y, z]) => [x, y, z]));
  const triangles = profile.flatMap((_, at) => {
    const next = (at + 1) % count;
    const fan = at > 0 && next > 0 ? [0, next, at, count, count + at, count + next] : [];
    return [at, next, count + at, next, count + next, count + at, ...fan];
  });
  return { vertices: Float32Array.from(vertices), triangles: Uint32Array.from(triangles) };
}

function joined(a: Mesh, b: Mesh): Mesh {
  const shifted = b.triangles.map((vertex) => vertex + a.vertices.length / 3);
  return { vertices: Float32Array.of(...a.vertices, ...b.vertices), triangles: Uint32Array.of(...a.triangles, ...shifted) };
}

/** Half a ring, as a femoral component is from the side. */
function bow(): Mesh {
  const arc = (radius: number, back: boolean) => Array.from({ length: 37 }, (_, at): [number, number] => {
    const angle = (Math.PI * (back ? 36 - at : at)) / 36;
    return [radius * Math.cos(angle), -radius * Math.sin(angle)];
  });
  return pulled([...arc(32, false), ...arc(25, true)], 60);
}

/** A plate on a keel. */
function tray(): Mesh {
  const plate = pulled([[-22, 0], [22, 0], [22, 4], [-22, 4]], 70);
  return joined(plate, pulled([[-6, -35], [6, -35], [6, 0], [-6, 0]], 12));
}

function turned({ vertices, triangles }: Mesh, angle: number): Mesh {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const moved = Float32Array.from(vertices, (_, at) => {
    const [x, y, z] = [vertices[at - (at % 3)]!, vertices[at - (at % 3) + 1]!, vertices[at - (at % 3) + 2]!];
    const [u, v, w] = [c * x - s * y, s * x + c * y, z];
    return [u, c * v - s * w, s * v + c * w][at % 3]!;
  });
  return { vertices: moved, triangles };
}

describe('what a shape tells', () => {
  it('a plate is a tray and a bow is none, whichever way they lie', () => {
    for (const angle of [0, 0.4, 1.1, 2.5]) {
      expect(shapeKindOf(turned(tray(), angle))).toBe('tray');
      expect(shapeKindOf(turned(bow(), angle))).toBe('bow');
    }
  });

  it('the part is that of the surface, and does not depend on the way round', () => {
    const slab = pulled([[0, 0], [10, 0], [10, 1], [0, 1]], 10);
    expect(plateFraction(slab)).toBeCloseTo(200 / 240, 6);
    expect(plateFraction({ ...slab, triangles: slab.triangles.toReversed() })).toBeCloseTo(200 / 240, 6);
    expect(plateFraction({ vertices: new Float32Array(), triangles: new Uint32Array() })).toBe(0);
  });
});
