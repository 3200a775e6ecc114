import { describe, expect, it } from 'vitest';
import { addFrames, setCalibration, setLibrarySpec, setModel } from '../../src/document/commands';
import { DEFAULT_LIBRARY, DEFAULT_WINDOW, EMPTY_DOC, type LibrarySpec } from '../../src/document/types';
import { libraryKey } from '../../src/results/keys';

function keyOf(spec: LibrarySpec): string | null {
  const commands = [
    addFrames([{ id: 'f', name: 'f', source: 'f', indexInSource: 0, width: 8, height: 9 }]),
    setCalibration({ name: 'c', text: 'c' }),
    setModel('femur', { name: 'm', sha256: 'ab' }),
    setLibrarySpec('femur', spec),
  ];
  return libraryKey(commands.reduce((doc, command) => command.apply(doc), EMPTY_DOC), 'femur');
}

describe('the key of a library', () => {
  it('is that of earlier sessions for a window: what was found then is not found anew', () => {
    const settings = '{"nominalX":0,"nominalY":0,"xFrom":-15,"xTo":15,"xStep":1,"yFrom":-20,"yTo":20,"yStep":1,"distance":null,"area":15000}';
    expect(keyOf(DEFAULT_WINDOW)).toBe(`model ab views ${settings} frame 8x9 camera "c"`);
  });

  it('tells all directions from a window, and distances apart', () => {
    expect(keyOf(DEFAULT_LIBRARY)).toBe('model ab views all directions {"distance":null} frame 8x9 camera "c"');
    expect(keyOf({ views: 'all directions', distance: 900 })).not.toBe(keyOf(DEFAULT_LIBRARY));
  });
});
