import { JointReport, KneeJoint, KneeMiddles, writeJtak, writeJtap, writeTra } from '../../pkg/core/fluoropose_wasm.js';
import { numbersOf } from '../../geometry/axes';
import { COMPONENT_NAMES } from '../../terms/component';
import type { FlippedLook, JointPart, JointProtocol, JointText, KneeFilm, LyingPose, PoseText, PublishedFilm, Uncertain } from '../protocol/joint';
import { NO_POSE, poseArray, posesArray, uncertaintyArray } from '../protocol/pose_array';
import { withImage } from './frame_pixels';
import type { Handlers } from './serve';

const NOTHING = new Float64Array();

/** The joint between two components, open in this worker. */
export function joint(ready: Promise<unknown>): Handlers<JointProtocol> {
  let open: KneeJoint | null = null;
  let middles: { readonly key: string; readonly of: KneeMiddles } | null = null;
  const middlesOf = ({ key, femur, tibia }: KneeFilm): KneeMiddles => {
    if (middles?.key !== key) {
      middles?.of.free();
      middles = null;
      middles = { key, of: new KneeMiddles(...partOf(femur), ...partOf(tibia)) };
    }
    return middles.of;
  };
  return {
    openJoint: async ({ femur, tibia, side }) => {
      await ready;
      open?.free();
      open = null;
      open = new KneeJoint(...partOf(femur), ...partOf(tibia), side === 'left');
      return { columns: open.columns, hasPlate: open.hasPlate, plate: open.plateOutline(), otherSide: open.otherSide() ?? null };
    },
    joint: async (frames) => {
      const joint = open;
      if (!joint) throw new Error('No joint is open');
      const asked = frames.flatMap(({ femur, tibia }) => [...uncertain(femur), ...uncertain(tibia)]);
      const numbers = joint.numbers(Float64Array.from(asked)) as Float64Array<ArrayBuffer>;
      const width = numbers.length / Math.max(1, frames.length);
      const rows = frames.map((_, at) => numbers.subarray(at * width, (at + 1) * width));
      return { numbers, impossible: rows.map((row) => joint.impossible(row) ?? null), originsApart: rows.map((row) => joint.originsApart(row) ?? null) };
    },
    lyingBeside: async (film) => {
      await ready;
      const [knee, frames] = [middlesOf(film), lyingNumbers(film)];
      const isBeyond = knee.beyondFlipping(frames);
      return (knee.told(frames) as (string | null)[]).map((sentence, frame) => (sentence === null ? null : { sentence, isBeyondFlipping: isBeyond[frame] === 1 }));
    },
    beginFlipped: async (film) => {
      await ready;
      const begun = middlesOf(film);
      begun.beginFlipped(lyingNumbers(film));
      return lookOf(begun);
    },
    lookFlipped: ({ camera: { text, width, height }, film, ...pixels }) =>
      withImage(pixels, async (image) => {
        if (!middles) throw new Error('No knee is looked at');
        middles.of.lookFlipped(image, text, width, height, Float64Array.from(film ?? []));
        return lookOf(middles.of);
      }),
    publish: ({ film, what }) => published(open, film, (report) => textOf(report, what)),
    figurePdf: (film) => published(open, film, (report) => report.figurePdf() as Uint8Array<ArrayBuffer>),
    poseText: async (text) => {
      await ready;
      return poseText(text);
    },
  };
}

function lyingNumbers({ frames }: KneeFilm): Float64Array {
  const numbers = (lying: LyingPose | null) => (lying ? [...poseArray(lying.pose), lying.depth ?? NaN] : [...NO_POSE, NaN]);
  return Float64Array.from(frames.flatMap(({ femur, tibia }) => [...numbers(femur), ...numbers(tibia)]));
}

function lookOf(middles: KneeMiddles): FlippedLook | null {
  const [component, frame] = middles.wantedFlipped ?? [];
  return component === undefined || frame === undefined ? null : { component: COMPONENT_NAMES[component]!, frame };
}

function published<T>(joint: KneeJoint | null, film: PublishedFilm, made: (report: JointReport) => T): T {
  if (!joint) throw new Error('No joint is open');
  const report = reportOf(joint, film);
  try {
    return made(report);
  } finally {
    report.free();
  }
}

function reportOf(joint: KneeJoint, { name, rate, frames, inputs, settings, remarks }: PublishedFilm): JointReport {
  const report = new JointReport(joint, name, rate);
  for (const { numbers, checked, doubt, accepted } of frames) report.addFrame(numbers ?? NOTHING, checked, doubt ?? undefined, accepted ?? undefined);
  for (const input of inputs) report.addInput(input.what, input.name, input.sha256);
  for (const [setting, value] of settings) report.addSetting(setting, value);
  for (const remark of remarks) report.addRemark(remark);
  return report;
}

function textOf(report: JointReport, what: JointText): string {
  switch (what.form) {
    case 'table':
      return report.table();
    case 'mot':
      return report.mot();
    case 'cycle':
      return report.cycle(what.column);
    case 'figure':
      return report.figure();
    case 'report':
      return report.html();
  }
}

function poseText(text: PoseText): string {
  switch (text.form) {
    case 'jtak':
      return writeJtak(posesArray(text.poses));
    case 'jtap':
      return writeJtap(posesArray(text.poses));
    case 'tra':
      return writeTra(posesArray(text.poses.femur), posesArray(text.poses.tibia));
  }
}

function partOf({ mesh, axes }: JointPart): [Float32Array, Uint32Array, Float64Array] {
  return [mesh?.vertices ?? new Float32Array(), mesh?.triangles ?? new Uint32Array(), numbersOf(axes)];
}

function uncertain({ pose, deviations }: Uncertain): readonly number[] {
  return [...poseArray(pose), ...uncertaintyArray(deviations)];
}
