/** Runs in a worker of its own, on the npm module's core: times its work and posts milliseconds. */
import init, { Matcher, Surroundings, Traced } from '/npm/pkg/core/fluoropose_wasm.js';
import { decodeModel } from '/npm/decode.js';
import { buildLibrary } from '/npm/library.js';

const FRAME = { width: 1024, height: 1024 };
/** The clock of a page ticks every 0.1 ms. */
const SEARCHES = 400;
const ROUNDS = 5;
/** Of a point that goes round in a circle. */
const STEPS = 60;

onmessage = ({ data }) => {
  work(data).then(postMessage, (error) => postMessage({ failed: String(error) }));
};

/** @param {{ masks: [number, number][][], polygons: [number, number][][] }} task */
async function work({ masks, polygons }) {
  await init({ module_or_path: '/npm/pkg/core/fluoropose_wasm_bg.wasm' });
  const [model, calibration] = await Promise.all([fetched('femur.stl', 'arrayBuffer'), fetched('calibration.txt', 'text')]);
  const { mesh } = await decodeModel(new Uint8Array(model));
  const options = { model: mesh, calibration, frame: FRAME };
  const from = performance.now();
  const bytes = await buildLibrary(mesh, options);
  const library = performance.now() - from;
  const matcher = new Matcher(bytes);
  matcher.takeModel(mesh.vertices, mesh.triangles);
  const traced = (points) => new Traced(Float64Array.from(points.flat()), new Uint32Array(), calibration, FRAME.width, FRAME.height);
  const around = new Surroundings();
  const refine = (outline) => timed(() => matcher.refineOutline(outline, around).free());
  const whole = masks.map(traced);
  const refined = (outlines) => Array.from({ length: ROUNDS }).flatMap(() => outlines.map(refine));
  refine(whole[0]);
  return {
    library,
    best: whole.map((outline) => searched(matcher, outline)),
    masks: refined(whole),
    polygons: refined(polygons.map(traced)),
    live: followed(matcher, traced(polygons[0]), moving(polygons[0]).map((points) => () => traced(points))),
  };
}

/** @param {string} name @param {'arrayBuffer' | 'text'} as */
async function fetched(name, as) {
  return (await fetch(`/demo/${name}`))[as]();
}

function searched(matcher, outline) {
  const canonical = matcher.canonical(outline);
  return timed(() => {
    for (let search = 0; search < SEARCHES; search++) matcher.nearestView(canonical).free();
  }) / SEARCHES;
}

/** A refined pose goes along with an outline, as in the page. */
function followed(matcher, outline, steps) {
  const start = matcher.refineOutline(outline, new Surroundings());
  let [pose, residual] = [start.pose(0), start.residual(0)];
  return steps.map((next) =>
    timed(() => {
      const traced = next();
      const found = matcher.follow(traced, pose, Float64Array.of(residual));
      if (!found) throw new Error('the pose was lost');
      [pose, residual] = [found.pose(0), found.residual(0)];
      found.free();
      traced.free();
    }),
  );
}

/** An outline with one point that goes round. @param {[number, number][]} outline */
function moving([first, ...rest]) {
  return Array.from({ length: STEPS }, (_, step) => {
    const angle = (2 * Math.PI * step) / STEPS;
    return [[first[0] + 3 * Math.sin(angle), first[1] + 3 * (1 - Math.cos(angle))], ...rest];
  });
}

/** @param {() => void} work */
function timed(work) {
  const from = performance.now();
  work();
  return performance.now() - from;
}
