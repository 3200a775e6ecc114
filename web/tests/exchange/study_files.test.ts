import { describe, expect, it } from 'vitest';
import type { Incoming } from '../../src/exchange/incoming';
import { at, pageOfFiles } from './page_of_files';

const study = (path: string, lines: string) => at(path, `name = "${path.split('/').at(-2) || 'knee'}"\nside = "left"\n${lines}`);
const femur = (model: string) => `[[component]]\nname = "femur"\nmodel = "${model}"\n`;

async function opened(...files: Incoming[]) {
  const page = pageOfFiles();
  await page.open(...files);
  const { doc } = page.store;
  const digest = async (path: string) => (await page.assets.add('', new Blob([path]))).sha256;
  const isModel = async (path: string) => doc.components.femur.model?.sha256 === (await digest(path));
  return { ...page, doc, isModel };
}

describe('a study that names its files', () => {
  it('gets those, and others are left out by name', async () => {
    const { doc, said } = await opened(
      study('/s/study.toml', `calibration = "camera_a.txt"\n${femur('size3.stl')}`),
      ...['camera_a.txt', 'camera_b.txt', 'size3.stl', 'size4.stl', 'f1.png'].map((name) => at(`/s/${name}`)),
    );
    expect(doc.calibration?.name).toBe('camera_a.txt');
    expect(doc.components.femur.model?.name).toBe('size3.stl');
    expect(doc.components.tibia.model).toBeNull();
    expect(said()).toContain('2 files are none that the study names for its calibration, femur and tibia (camera_a.txt and size3.stl, from its own folder) and left out: s/camera_b.txt and s/size4.stl.');
  });

  it('gets no other where those are not here', async () => {
    const { doc, said } = await opened(study('/s/study.toml', `calibration = "camera_a.txt"\n${femur('size3.stl')}`), at('/s/camera_b.txt'), at('/s/size4.stl'), at('/s/f1.png'));
    expect([doc.calibration, doc.components.femur.model]).toEqual([null, null]);
    expect(said()).toContain('left out: s/camera_b.txt and s/size4.stl');
  });

  it('gets those at its paths, not others of these names', async () => {
    const paths = ['calibration.txt', 'models/femur.stl', 'old/calibration.txt', 'old/models/femur.stl', 'frames/f1.png', 'old/frames/f1.png'];
    const { doc, isModel, frames } = await opened(
      study('/knee/study.toml', `calibration = "./calibration.txt"\nframes = "frames/"\n${femur('models/femur.stl')}`),
      ...paths.map((path) => at(`/knee/${path}`)),
    );
    expect(doc.calibration?.text).toBe('/knee/calibration.txt');
    expect(await isModel('/knee/models/femur.stl')).toBe(true);
    expect(frames()).toEqual(['f1.png']);
  });

  it('gets the one file that holds its frames', async () => {
    const { frames } = await opened(study('/knee/study.toml', `frames = "run.png"\n${femur('femur.stl')}`), ...['run.png', 'run.png.png', 'other.png'].map((name) => at(`/knee/${name}`)));
    expect(frames()).toEqual(['run.png']);
  });

  it('gets one beside its folder', async () => {
    const { isModel } = await opened(study('/all/knee/study.toml', femur('../models/femur.stl')), at('/all/models/femur.stl'), at('/all/knee/models/femur.stl'));
    expect(await isModel('/all/models/femur.stl')).toBe(true);
  });

  it('gets frames and poses that lie outside its folder, where no other study is', async () => {
    const { frames } = await opened(study('/knee/data/study.toml', femur('femur.stl')), at('/knee/data/femur.stl'), at('/knee/frames/f1.png'), at('/f2.png'));
    expect(frames()).toEqual(['f2.png', 'f1.png']);
  });

  it('gets the only one of a name where nobody tells folders, or it does not', async () => {
    const loose = await opened(study('study.toml', femur('models\\\\size3.stl')), at('size3.stl'), at('size4.stl'));
    expect(await loose.isModel('size3.stl')).toBe(true);
    const further = await opened(study('/s/study.toml', femur('size3.stl')), at('/s/models/size3.stl'));
    expect(await further.isModel('/s/models/size3.stl')).toBe(true);
    const two = await opened(study('/s/study.toml', femur('size3.stl')), at('/s/a/size3.stl'), at('/s/b/size3.stl'));
    expect(two.doc.components.femur.model).toBeNull();
    expect(two.said()).toContain('left out: s/a/size3.stl and s/b/size3.stl');
  });
});

describe('several studies', () => {
  const patient = (name: string, lines: string) => [
    study(`/all/${name}/study.toml`, lines),
    ...['calibration.txt', 'femur.stl', 'f1.png', 'f2.png'].map((file) => at(`/all/${name}/${file}`)),
  ];

  it('do not become one: the first is opened, and which are not is said', async () => {
    const { doc, isModel, said } = await opened(...patient('bert', femur('femur.stl')), ...patient('anna', femur('femur.stl')));
    expect(doc.name).toBe('anna');
    expect(doc.frames).toHaveLength(2);
    expect(doc.calibration?.text).toBe('/all/anna/calibration.txt');
    expect(await isModel('/all/anna/femur.stl')).toBe(true);
    expect(said()).toContain('These are several studies. all/anna/study.toml is opened; left out, with what lies beside it: all/bert/study.toml. Open each by its own folder.');
  });

  it('are the one above and old copies in it', async () => {
    const copies = ['calibration.txt', 'femur.stl', 'f1.png', 'a/calibration.txt', 'a/femur.stl', 'a/f1.png'].map((path) => at(`/knee/${path}`));
    const { doc, frames } = await opened(study('/knee/a/study.toml', femur('femur.stl')), study('/knee/study.toml', femur('femur.stl')), ...copies);
    expect(doc.name).toBe('knee');
    expect(doc.calibration?.text).toBe('/knee/calibration.txt');
    expect(frames()).toHaveLength(1);
  });

  it('are not opened where the study file of the first is wrong', async () => {
    const { doc, said } = await opened(...patient('anna', 'frames_per_s = "many"\n'), ...patient('bert', femur('femur.stl')));
    expect([doc.frames, doc.calibration, doc.components.femur.model]).toEqual([[], null, null]);
    expect(said()).toMatch(/study\.toml: .*frames_per_s.* These are several studies: all\/anna and all\/bert\. None was opened/);
  });

  it('without study files are told by their calibrations and frames, and none is opened', async () => {
    const { doc, said } = await opened(...['anna', 'bert'].flatMap((name) => patient(name, '').slice(1)));
    expect([doc.frames, doc.calibration, doc.components.femur.model]).toEqual([[], null, null]);
    expect(said()).toContain('These are several studies: all/anna and all/bert. None was opened');
  });
});

it('a calibration in a form of others is kept as the worker reads it', async () => {
  const { doc } = await opened(at('/k/calibration.txt', '%YAML:1.0'), at('/k/f1.png'));
  expect(doc.calibration).toEqual({ name: 'calibration.txt', text: 'JT_INTCALIB\n' });
});

describe('several files for one place, where no study tells', () => {
  it('are not taken, and a person opens the one that is meant', async () => {
    const { store, doc, said, open } = await opened(at('/a.txt'), at('/b.txt'), at('/femur_1.stl'), at('/femur_2.stl'), at('/tibia.stl'), at('/f1.png'));
    expect([doc.calibration, doc.components.femur.model, doc.components.tibia.model?.name]).toEqual([null, null, 'tibia.stl']);
    expect(doc.frames).toHaveLength(1);
    expect(said()).toContain('There are several calibrations: a.txt and b.txt. None of them was taken');
    expect(said()).toContain('There are several models of the femur: femur_1.stl and femur_2.stl.');
    await open(at('/b.txt'));
    await open(at('/femur_2.stl'));
    expect([store.doc.calibration?.name, store.doc.components.femur.model?.name]).toEqual(['b.txt', 'femur_2.stl']);
  });

  it('are one where they are copies', async () => {
    const { doc } = await opened(at('/a.txt', 'same'), at('/old/a.txt', 'same'), at('/femur.stl', 'same'), at('/old/femur.stl', 'same'));
    expect([doc.calibration?.name, doc.components.femur.model?.name]).toEqual(['a.txt', 'femur.stl']);
  });

  it('are two where a name tells of one, and the other place is free', async () => {
    const { doc } = await opened(at('/a.stl'), at('/femur.stl'));
    expect([doc.components.femur.model?.name, doc.components.tibia.model?.name]).toEqual(['femur.stl', 'a.stl']);
  });
});
