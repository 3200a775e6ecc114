import { auditTroubles } from '../document/session/audit';
import { readSession, type Session } from '../document/session/session';
import { isSilhouette } from '../document/laid_by';
import type { Doc } from '../document/types';
import { isReady } from '../results/steps';
import type { ToolName } from '../terms/tool';
import { later } from '../texts/later';
import { texts } from '../texts/texts';
import { bringFiles } from './bring_files';
import { type Incoming, textOf } from './incoming';
import { filesOf } from '../document/named_files';
import type { Services } from '../jobs/services';

/** Opens a session; what does not match its digests goes to `remarks`, by name. A command: undo brings back what was there. */
export async function openSession(services: Services, file: Incoming, remarks: string[]): Promise<string> {
  const session = readSession(await textOf(file));
  await takeFiles(services, session, remarks);
  const missing = await bringFiles(services, session.doc, remarks);
  const { store } = services;
  store.perform({ label: later.digests.openLabel, apply: () => session.doc });
  store.markSaved(store.doc);
  const { frameIndex, component, overlayOpacity } = session.view;
  store.show({ tool: toolFor(session.doc, store.ui.tool), component, overlayOpacity: Math.min(1, Math.max(0, overlayOpacity)), viewport: null, savedAt: null });
  store.goTo(frameIndex);
  if (session.audit) remarks.push(...(await auditTroubles(session.doc, session.audit)).map(later.digests.trouble));
  if (missing.length > 0) remarks.push(later.digests.missing(texts.listed(missing), missing.length));
  return `the session ${file.name}`;
}

/** Where clicks are all that there is, one click is the tool to go on with; whoever has traced, traces on. */
export function toolFor(doc: Doc, tool: ToolName): ToolName {
  const isTraced = doc.cells.entries().some(({ cell: { outline } }) => outline !== null && !isSilhouette(outline));
  return tool === 'trace' && isReady(doc) && !isTraced ? 'one-click' : tool;
}

/** The included copies, each against the digest it is named by. */
async function takeFiles({ assets }: Services, session: Session, remarks: string[]): Promise<void> {
  for (const { name, sha256, bytes } of session.files) {
    if (!bytes) continue;
    const asset = await assets.add(name, new Blob([bytes]));
    if (asset.sha256 !== sha256) remarks.push(later.digests.damaged(name, short(asset.sha256), short(sha256)));
  }
}

/** A sentence where a file has the name of one that the document waits for, but not its content. */
export async function mismatchOf({ store, assets }: Services, { name, blob }: Incoming): Promise<string | null> {
  const awaited = filesOf(store.doc).filter((reference) => reference.name === name && !assets.get(reference.sha256));
  if (awaited.length === 0) return null;
  const { sha256 } = await assets.add(name, blob);
  const found = awaited.every((reference) => reference.sha256 !== sha256);
  return found ? later.digests.another(name, short(sha256), short(awaited[0]!.sha256)) : null;
}

function short(sha256: string): string {
  return `${sha256.slice(0, 12)}...`;
}
