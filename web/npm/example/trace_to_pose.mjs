// node trace_to_pose.mjs MODEL CALIBRATION OUTLINE: prints the pose of the model that explains the outline.
import { readFile } from 'node:fs/promises';
import { openImplant } from 'fluoropose';

const [modelFile, calibrationFile, outlineFile] = process.argv.slice(2);
if (!outlineFile) {
  console.error('usage: node trace_to_pose.mjs MODEL CALIBRATION OUTLINE');
  process.exit(2);
}

const model = await readFile(modelFile);
const calibration = await readFile(calibrationFile, 'utf8');
const { frame, outline } = JSON.parse(await readFile(outlineFile, 'utf8'));

const implant = await openImplant({ model, calibration, frame });
const { pose, verdict, candidates } = implant.pose(outline);

console.log(JSON.stringify({ pose, verdict, deviations: candidates[0].deviations, rivals: candidates.length - 1 }, null, 2));
implant.close();
