/** What made a session or a pose: name and version. */
export const PROGRAM = `fluoropose ${__VERSION__}`;
