import type { ComponentChildren } from 'preact';
import { useLayoutEffect, useRef } from 'preact/hooks';
import type { Popover, State } from '../document/store';
import { titleOf } from '../terms/component';
import { useApp } from '../commands/app';
import { later } from '../commands/later';
import { Icon } from '../controls/icons';
import { LogSheet } from '../sheets/log_sheet';
import { texts } from '../texts/texts';

const CalibrateSheet = later(async () => (await import('../sheets/calibrate_sheet')).CalibrateSheet);
const CalibrationSheet = later(async () => (await import('../sheets/calibration_sheet')).CalibrationSheet);
const ComponentSheet = later(async () => (await import('../sheets/component_sheet')).ComponentSheet);
const ConvergenceSheet = later(async () => (await import('../sheets/convergence_sheet')).ConvergenceSheet);
const ExportSheet = later(async () => (await import('../sheets/export_sheet')).ExportSheet);
const FilmSheet = later(async () => (await import('../sheets/film_sheet')).FilmSheet);
const ImportSheet = later(async () => (await import('../steps/open/import_sheet')).ImportSheet);
const KeySheet = later(async () => (await import('../sheets/key_sheet')).KeySheet);
const SetsSheet = later(async () => (await import('../steps/open/sets_sheet')).SetsSheet);
const ShapeSheet = later(async () => (await import('../sheets/shape_sheet')).ShapeSheet);
const VideoSheet = later(async () => (await import('../steps/open/video_sheet')).VideoSheet);
const ViewSheet = later(async () => (await import('../sheets/view_sheet')).ViewSheet);
const WorkSheet = later(async () => (await import('../sheets/work_sheet')).WorkSheet);

/** What opens over the page, one at a time. Nothing here is modal: the page behind goes on working. */
export function Popovers({ state }: { state: State }) {
  const { popover } = state.ui;
  if (!popover) return null;
  return (
    <Sheet key={popover} name={popover} title={TITLES[popover]}>
      {contents(popover, state)}
    </Sheet>
  );
}

const TITLES: Readonly<Record<Popover, string>> = {
  calibration: texts.sheets.calibration,
  femur: titleOf('femur'),
  tibia: titleOf('tibia'),
  keys: texts.sheets.keys,
  log: texts.sheets.log,
  export: texts.exporting.title,
  convergence: texts.sheets.convergence,
  work: texts.work.list,
  import: texts.exchange.title,
  shape: texts.tracing.shape.title,
  view: texts.seeing.sheet,
  calibrate: texts.calibrate.sheet,
  video: texts.files.video.sheet,
  film: texts.film.sheet,
  sets: texts.files.sets.title,
};

function contents(popover: Popover, state: State): ComponentChildren {
  switch (popover) {
    case 'calibration':
      return <CalibrationSheet state={state} />;
    case 'femur':
    case 'tibia':
      return <ComponentSheet state={state} component={popover} />;
    case 'keys':
      return <KeySheet />;
    case 'log':
      return <LogSheet state={state} />;
    case 'export':
      return <ExportSheet state={state} />;
    case 'work':
      return <WorkSheet state={state} />;
    case 'import':
      return <ImportSheet state={state} />;
    case 'convergence':
      return <ConvergenceSheet state={state} />;
    case 'shape':
      return <ShapeSheet state={state} />;
    case 'calibrate':
      return <CalibrateSheet state={state} />;
    case 'video':
      return <VideoSheet state={state} />;
    case 'film':
      return <FilmSheet state={state} />;
    case 'sets':
      return <SetsSheet state={state} />;
    case 'view':
      return <ViewSheet state={state} />;
  }
}

function Sheet({ name, title, children }: { name: Popover; title: string; children: ComponentChildren }) {
  const { store } = useApp().services;
  const sheet = useRef<HTMLElement>(null);
  // Before it is seen: a key that is pressed then is not for the pose behind it.
  useLayoutEffect(() => {
    const before = document.activeElement;
    sheet.current?.focus();
    return () => {
      if (before instanceof HTMLElement) before.focus();
    };
  }, []);
  return (
    <section ref={sheet} class={`sheet ${name}-sheet`} role="dialog" aria-label={title} tabIndex={-1}>
      <div class="sheet-head">
        <h2>{title}</h2>
        <button type="button" class="button square small" aria-label={texts.close(title)} title={texts.closeTitle} onClick={() => store.show({ popover: null })}>
          <Icon name="close" />
        </button>
      </div>
      {children}
    </section>
  );
}
