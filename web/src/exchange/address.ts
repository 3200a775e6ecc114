declare global {
  /** In the page that is one file: the address under which a part of it can be fetched. */
  var embedded: { address(name: string): string } | undefined;
}

/** Where a file that comes with the page is: beside it, or inside it. */
export function addressOf(name: string): string {
  return globalThis.embedded?.address(name) ?? `./${name}`;
}
