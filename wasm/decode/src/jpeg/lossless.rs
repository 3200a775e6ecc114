//! Lossless JPEG (process 14, all predictors, 2 to 16 bits), after ITU-T T.81 annex H.
//!
//! X-ray units write this coding. The library that decodes the other processes does not reset its prediction after a
//! restart mark and applies the point transform to predictions twice, so this coding is decoded here. The markers have been
//! walked before.

use super::huffman::{Bits, Table, Tables, intervals};
use super::markers::{
    END_OF_IMAGE, FORMAT, Process, REMEDY, RESTART_INTERVAL, START_OF_IMAGE, START_OF_SCAN, TABLES,
    cut, end_of_scan, frame_header, restart_interval, segment, starts_frame,
};
use crate::error::Problem;

/// Samples of each component, one plane after the other.
pub(super) struct Planes {
    pub planes: Vec<Vec<u16>>,
}

/// What the markers before a scan have set.
struct Decoder {
    width: usize,
    height: usize,
    precision: u32,
    /// Identifiers of the components in the order of the frame header.
    components: Vec<u8>,
    tables: Tables,
    restart: usize,
    planes: Vec<Vec<u16>>,
}

/// Decodes every scan. The image's markers are sound and its area allowed.
pub(super) fn decode(bytes: &[u8]) -> Result<Planes, Problem> {
    let early = || cut("it ends before the end-of-image mark");
    let mut decoder: Option<Decoder> = None;
    let mut tables = Tables::default();
    let (mut at, mut restart) = (2, 0);
    debug_assert!(bytes.starts_with(&[0xFF, START_OF_IMAGE]));
    loop {
        let marker = *bytes.get(at + 1).ok_or_else(early)?;
        if marker == 0xFF {
            at += 1;
            continue;
        }
        if marker == END_OF_IMAGE {
            break;
        }
        let body = segment(bytes, at + 2).ok_or_else(early)?;
        at += 4 + body.len();
        match marker {
            TABLES => tables.read(body)?,
            RESTART_INTERVAL => restart = restart_interval(body)?,
            START_OF_SCAN => {
                let end = end_of_scan(bytes, at, Process::Lossless).ok_or_else(early)?;
                let decoder = decoder
                    .as_mut()
                    .ok_or_else(|| cut("a scan comes before the frame header"))?;
                (decoder.tables, decoder.restart) = (tables.clone(), restart);
                decoder.scan(body, bytes.get(at..end).unwrap_or_default())?;
                at = end;
            }
            marker if starts_frame(marker) => decoder = Some(Decoder::new(marker, body)?),
            _ => {}
        }
    }
    let planes = decoder.map(|decoder| decoder.planes).unwrap_or_default();
    match planes.iter().any(Vec::is_empty) || planes.is_empty() {
        true => Err(cut("not all of its components have pixels")),
        false => Ok(Planes { planes }),
    }
}

impl Decoder {
    fn new(marker: u8, body: &[u8]) -> Result<Self, Problem> {
        let header =
            frame_header(marker, body).ok_or_else(|| cut("its frame header is cut short"))?;
        let specifications = body.get(6..6 + 3 * usize::from(header.components));
        let specifications = specifications
            .ok_or_else(|| cut("its frame header is cut short"))?
            .as_chunks::<3>()
            .0;
        if specifications
            .iter()
            .any(|[_, sampling, _]| *sampling != specifications[0][1])
        {
            let what = "lossless colours of different resolutions";
            return Err(Problem::unsupported(FORMAT, what, REMEDY));
        }
        if !(2..=16).contains(&header.precision) {
            return Err(cut(&format!("it states {} bits a pixel", header.precision)));
        }
        Ok(Self {
            width: header.width.into(),
            height: header.height.into(),
            precision: header.precision.into(),
            components: specifications.iter().map(|[id, ..]| *id).collect(),
            tables: Tables::default(),
            restart: 0,
            planes: vec![Vec::new(); specifications.len()],
        })
    }

    /// One scan: its header and its coded bytes.
    fn scan(&mut self, header: &[u8], coded: &[u8]) -> Result<(), Problem> {
        let scan = Scan::read(header, &self.components, self.precision)?;
        let count = scan.components.len();
        let rows = match self.restart {
            0 => self.height,
            interval if interval % self.width == 0 => interval / self.width,
            _ => return Err(cut("its restart interval is no number of whole rows")),
        };
        let tables = scan.components.iter();
        let tables = tables.map(|&(_, table)| self.tables.lengths(table));
        let tables: Vec<Table> = tables.collect::<Result<_, _>>()?;
        let mut planes = vec![vec![0u16; self.width * self.height]; count];
        let mut intervals = intervals(coded).into_iter();
        for first in (0..self.height).step_by(rows) {
            let range = intervals
                .next()
                .ok_or_else(|| cut("a restart mark is missing"))?;
            let mut bits = Bits::new(&coded[range]);
            for row in first..(first + rows).min(self.height) {
                for column in 0..self.width {
                    for (plane, table) in planes.iter_mut().zip(&tables) {
                        let difference = table.difference(&mut bits)?;
                        let place = Place {
                            row,
                            column,
                            first,
                            width: self.width,
                        };
                        let predicted = scan.predict(plane, place);
                        plane[row * self.width + column] = predicted.wrapping_add(difference);
                    }
                }
            }
        }
        let most = u16::MAX >> (16 - self.precision);
        for (plane, &(component, _)) in planes.into_iter().zip(&scan.components) {
            self.planes[component] = plane
                .into_iter()
                .map(|value| (value << scan.shift) & most)
                .collect();
        }
        Ok(())
    }
}

/// What a scan header says.
struct Scan {
    /// Index of the component and of its code table.
    components: Vec<(usize, usize)>,
    predictor: u8,
    shift: u32,
    /// What the first sample is predicted as.
    middle: u16,
}

/// Where a sample stands; `first` is the row that a restart interval begins with.
#[derive(Clone, Copy)]
struct Place {
    row: usize,
    column: usize,
    first: usize,
    width: usize,
}

impl Scan {
    fn read(header: &[u8], components: &[u8], precision: u32) -> Result<Self, Problem> {
        let odd = || cut("a scan header is not one");
        let (&count, rest) = header.split_first().ok_or_else(odd)?;
        let (selectors, rest) = rest
            .split_at_checked(2 * usize::from(count))
            .ok_or_else(odd)?;
        let &[predictor, _, shift] = rest else {
            return Err(odd());
        };
        let shift = u32::from(shift & 0x0F);
        if !(1..=7).contains(&predictor) || shift >= precision || count == 0 {
            return Err(cut(&format!(
                "predictor {predictor} with a shift of {shift} bits is not possible"
            )));
        }
        let pairs = selectors.as_chunks::<2>().0.iter().map(|[id, tables]| {
            let component = components.iter().position(|known| known == id)?;
            Some((component, usize::from(tables >> 4)))
        });
        let pairs: Vec<_> = pairs.collect::<Option<_>>().ok_or_else(odd)?;
        if pairs.iter().any(|&(_, table)| table > 3) {
            return Err(odd());
        }
        Ok(Self {
            components: pairs,
            predictor,
            shift,
            middle: 1 << (precision - shift - 1),
        })
    }

    /// Table H.1, and what stands for it at the left and upper border.
    fn predict(
        &self,
        plane: &[u16],
        Place {
            row,
            column,
            first,
            width,
        }: Place,
    ) -> u16 {
        let at = row * width + column;
        if row == first {
            return if column == 0 {
                self.middle
            } else {
                plane[at - 1]
            };
        }
        let above = plane[at - width];
        if column == 0 {
            return above;
        }
        let (a, b, c) = (
            i32::from(plane[at - 1]),
            i32::from(above),
            i32::from(plane[at - width - 1]),
        );
        let value = match self.predictor {
            1 => a,
            2 => b,
            3 => c,
            4 => a + b - c,
            5 => a + ((b - c) >> 1),
            6 => b + ((a - c) >> 1),
            _ => (a + b) >> 1,
        };
        // Modulo 2^16, as the standard has it.
        value as u16
    }
}
