import { axes, models, study } from './en_axes';
import { calibrateSheet as calibrate } from './en_calibrate_sheet';
import { check } from './en_check_card';
import { digests } from './en_digests';
import { exchange } from './en_exchange';
import { exporting } from './en_exporting';
import { filmSheet } from './en_film_sheet';
import { curves } from './en_joint_curves';
import { opening } from './en_opening';
import { calibration, convergence } from './en_sheets';

const english = { axes, calibrate, calibration, check, convergence, digests, exchange, exporting, filmSheet, curves, models, opening, study };

/** What is said by views that come when they are opened: apart from the rest, so that the first load does not have it. */
export const later: Readonly<typeof english> = english;
