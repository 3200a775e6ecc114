/** Dots an inch that journals ask of drawings with lines and words. */
const DPI = 600;
const MM_PER_INCH = 25.4;

/** A drawing that states its size in print, as a picture of that size. */
export async function pngOf(svg: string): Promise<Blob> {
  const address = URL.createObjectURL(new Blob([svg], { type: 'image/svg+xml' }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const [width, height] = sizeOf(svg);
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d');
    if (!context) throw new Error('this browser has no 2-D canvas');
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
    return await canvas.convertToBlob({ type: 'image/png' });
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** What a browser says of the picture's size is in whole px. */
function sizeOf(svg: string): [number, number] {
  const [, width, height] = /width="([\d.]+)mm" height="([\d.]+)mm"/.exec(svg) ?? [];
  const pixels = (mm: string | undefined) => Math.round((Number(mm) / MM_PER_INCH) * DPI);
  return [pixels(width), pixels(height)];
}
