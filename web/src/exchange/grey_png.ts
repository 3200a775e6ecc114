/** An 8-bit grey PNG of a picture, after the PNG specification (third edition), deflated by the browser. */
export async function greyPng(rgba: Uint8ClampedArray, width: number, height: number): Promise<Uint8Array<ArrayBuffer>> {
  // Each row begins with its filter: the difference to the row above makes smooth pictures small.
  const rows = new Uint8Array(height * (width + 1));
  for (let row = 0; row < height; row++) {
    const start = row * (width + 1);
    rows[start] = UP;
    for (let column = 0; column < width; column++) {
      const at = row * width + column;
      const above = row === 0 ? 0 : greyAt(rgba, at - width);
      rows[start + 1 + column] = greyAt(rgba, at) - above;
    }
  }
  const head = new Uint8Array(13);
  const view = new DataView(head.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  // Eight bits, grey, and the only compression, filtering and order without interlace that matter.
  head.set([8, 0, 0, 0, 0], 8);
  const parts = [SIGNATURE, chunk('IHDR', head), chunk('IDAT', await deflated(rows)), chunk('IEND', new Uint8Array(0))];
  const file = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    file.set(part, at);
    at += part.length;
  }
  return file;
}

const UP = 2;
const SIGNATURE = Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a);

/** The luminance that the decoders use: a grey stored as three equal channels comes back exactly. */
function greyAt(rgba: Uint8ClampedArray, pixel: number): number {
  const [red = 0, green = 0, blue = 0] = [rgba[4 * pixel], rgba[4 * pixel + 1], rgba[4 * pixel + 2]];
  return Math.floor((299 * red + 587 * green + 114 * blue + 500) / 1000);
}

async function deflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

function chunk(type: string, content: Uint8Array): Uint8Array {
  const out = new Uint8Array(12 + content.length);
  const view = new DataView(out.buffer);
  view.setUint32(0, content.length);
  out.set(Array.from(type, (letter) => letter.charCodeAt(0)), 4);
  out.set(content, 8);
  view.setUint32(8 + content.length, crc(out.subarray(4, 8 + content.length)));
  return out;
}

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let value = byte;
  for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
  return value;
});

function crc(bytes: Uint8Array): number {
  let value = 0xffffffff;
  for (const byte of bytes) value = (CRC_TABLE[(value ^ byte) & 0xff] ?? 0) ^ (value >>> 8);
  return ~value >>> 0;
}
