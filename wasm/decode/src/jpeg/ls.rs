//! JPEG-LS, lossless and near-lossless, 2 to 16 bits, after ITU-T T.87.
//!
//! Names are those of the field; the letters of the standard stand beside them. The markers have been walked before.

mod context;
mod parameters;

use super::markers::{
    END_OF_IMAGE, FORMAT, PARAMETERS, Process, REMEDY, RESTART_INTERVAL, START_OF_SCAN, cut,
    end_of_scan, frame_header, restart_interval, segment, starts_frame,
};
use crate::error::Problem;
use context::{Contexts, LineDecoder};
use parameters::{Parameters, Preset};

/// Samples of each component, one plane after the other, of an image whose area is allowed.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<Vec<u16>>, Problem> {
    let early = || cut("it ends before the end-of-image mark");
    let (mut at, mut frame, mut preset) = (2, None::<Frame>, Preset::default());
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
            PARAMETERS => preset = Preset::read(body)?,
            RESTART_INTERVAL if restart_interval(body)? != 0 => {
                return Err(Problem::unsupported(
                    FORMAT,
                    "JPEG-LS with restart marks",
                    REMEDY,
                ));
            }
            START_OF_SCAN => {
                let end = end_of_scan(bytes, at, Process::Ls).ok_or_else(early)?;
                let frame = frame
                    .as_mut()
                    .ok_or_else(|| cut("a scan comes before the frame header"))?;
                frame.scan(body, &bytes[at..end], preset)?;
                at = end;
            }
            marker if starts_frame(marker) => frame = Some(Frame::read(marker, body)?),
            _ => {}
        }
    }
    let planes = frame.map(|frame| frame.planes).unwrap_or_default();
    match planes.iter().any(Vec::is_empty) || planes.is_empty() {
        true => Err(cut("not all of its components have pixels")),
        false => Ok(planes),
    }
}

/// What the frame header says, and the components that have been decoded.
struct Frame {
    width: usize,
    height: usize,
    precision: u8,
    /// Identifiers of the components.
    components: Vec<u8>,
    planes: Vec<Vec<u16>>,
}

/// In which order the samples of several components come (ILV).
#[derive(Clone, Copy, PartialEq, Eq)]
enum Interleaving {
    /// One component, or lines of each by turns.
    Lines,
    /// A sample of each by turns.
    Samples,
}

impl Frame {
    fn read(marker: u8, body: &[u8]) -> Result<Self, Problem> {
        let short = || cut("its frame header is cut short");
        let header = frame_header(marker, body).ok_or_else(short)?;
        let specifications = body.get(6..6 + 3 * usize::from(header.components));
        let specifications = specifications.ok_or_else(short)?.as_chunks::<3>().0;
        if specifications
            .iter()
            .any(|[_, sampling, _]| *sampling != 0x11)
        {
            let what = "JPEG-LS colours of different resolutions";
            return Err(Problem::unsupported(FORMAT, what, REMEDY));
        }
        if !(2..=16).contains(&header.precision) {
            return Err(cut(&format!("it states {} bits a pixel", header.precision)));
        }
        Ok(Self {
            width: header.width.into(),
            height: header.height.into(),
            precision: header.precision,
            components: specifications.iter().map(|[id, ..]| *id).collect(),
            planes: vec![Vec::new(); specifications.len()],
        })
    }

    /// One scan: its header and its coded bytes.
    fn scan(&mut self, header: &[u8], coded: &[u8], preset: Preset) -> Result<(), Problem> {
        let odd = || cut("a scan header is not one");
        let (&count, rest) = header.split_first().ok_or_else(odd)?;
        let (selectors, rest) = rest
            .split_at_checked(2 * usize::from(count))
            .ok_or_else(odd)?;
        let &[near, interleaving, shift] = rest else {
            return Err(odd());
        };
        let place = |[id, table]: &[u8; 2]| match table {
            0 => Ok(self
                .components
                .iter()
                .position(|known| known == id)
                .ok_or_else(odd)?),
            _ => Err(Problem::unsupported(
                FORMAT,
                "JPEG-LS with a table of values",
                REMEDY,
            )),
        };
        let places: Vec<usize> = selectors
            .as_chunks::<2>()
            .0
            .iter()
            .map(place)
            .collect::<Result<_, _>>()?;
        let interleaving = match (interleaving, places.len()) {
            (0, 1) | (1, 1..) => Interleaving::Lines,
            (2, 1..) => Interleaving::Samples,
            _ => return Err(odd()),
        };
        if shift & 0x0F != 0 {
            return Err(Problem::unsupported(
                FORMAT,
                "JPEG-LS with a point transform",
                REMEDY,
            ));
        }
        let parameters = preset.parameters(self.precision, near)?;
        let planes = self.planes_of(places.len(), coded, parameters, interleaving)?;
        for (plane, place) in planes.into_iter().zip(places) {
            self.planes[place] = plane;
        }
        Ok(())
    }

    /// The planes of `count` components that are coded together.
    fn planes_of(
        &self,
        count: usize,
        coded: &[u8],
        parameters: Parameters,
        interleaving: Interleaving,
    ) -> Result<Vec<Vec<u16>>, Problem> {
        let mut decoder = LineDecoder::new(coded, parameters, count);
        let mut contexts = Contexts::new(&parameters);
        // A sample more on either side: what stands for neighbours beyond the border.
        let mut above = vec![vec![0; self.width + 2]; count];
        let mut lines = above.clone();
        let mut planes = vec![Vec::new(); count];
        for _ in 0..self.height {
            for (line, above) in lines.iter_mut().zip(&mut above) {
                line[0] = above[1];
                above[self.width + 1] = above[self.width];
            }
            match interleaving {
                Interleaving::Samples if count > 1 => {
                    decoder.samples(&mut contexts, &above, &mut lines)?
                }
                _ => {
                    for (component, line) in lines.iter_mut().enumerate() {
                        decoder.line(&mut contexts, component, &above[component], line)?;
                    }
                }
            }
            for (plane, line) in planes.iter_mut().zip(&lines) {
                plane.extend(line[1..=self.width].iter().map(|&sample| sample as u16));
            }
            std::mem::swap(&mut above, &mut lines);
        }
        Ok(planes)
    }
}
