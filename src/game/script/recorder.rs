//! Records what a player wants as a script.

use std::io::{self, Write};

use super::{Header, Stretch};
use crate::game::Intents;

/// Writes a script while the game is played.
///
/// A stretch is written when it ends, in one piece, so that the output is a script at any time. The
/// last stretch is written when the recorder is [finished](Recorder::finish) or dropped.
#[derive(Debug)]
pub struct Recorder<W: Write> {
    output: W,
    /// It is written before the first stretch, so that a game that did not start leaves nothing.
    header: Option<Header>,
    current: Option<Stretch>,
}

impl<W: Write> Recorder<W> {
    /// A recorder that writes to `output`.
    pub fn new(output: W) -> Self {
        Self { output, header: None, current: None }
    }

    /// A recorder that writes `header` before the script.
    pub fn with_header(output: W, header: Header) -> Self {
        let header = Some(header).filter(|header| !header.is_empty());
        Self { output, header, current: None }
    }

    /// Records that the player wants `intents` for `steps` more steps.
    ///
    /// # Errors
    /// If `output` fails.
    pub fn record(&mut self, intents: Intents, mut steps: u64) -> io::Result<()> {
        while steps > 0 {
            let before = match self.current {
                Some(stretch) if stretch.intents == intents => stretch.steps,
                _ => {
                    self.write_current()?;
                    0
                }
            };
            let taken = steps.min(u64::from(Stretch::MOST_STEPS - before)) as u32;
            steps -= u64::from(taken);
            self.current = Some(Stretch { steps: before + taken, intents });
            if steps > 0 {
                self.write_current()?;
            }
        }
        Ok(())
    }

    /// Writes the last stretch.
    ///
    /// # Errors
    /// If `output` fails.
    pub fn finish(&mut self) -> io::Result<()> {
        self.write_current()?;
        self.output.flush()
    }

    fn write_current(&mut self) -> io::Result<()> {
        let Some(stretch) = self.current.take() else { return Ok(()) };
        if let Some(header) = self.header.take() {
            self.output.write_all(format!("{header}\n").as_bytes())?;
        }
        self.output.write_all(format!("{stretch}\n").as_bytes())
    }
}

impl<W: Write> Drop for Recorder<W> {
    fn drop(&mut self) {
        // Callers who need the error have called `finish`.
        _ = self.finish();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Script;
    use super::*;
    use crate::game::Intent;

    proptest! {
        #[test]
        fn what_was_recorded_is_what_happened(
            happened in prop::collection::vec((0..3_usize, 0..400_u64), 1..20)
        ) {
            let wants = [Intents::new(), [Intent::Run].into_iter().collect(), Intent::ALL.into_iter().collect()];
            prop_assume!(happened.iter().any(|&(_, steps)| steps > 0));
            let mut text = Vec::new();
            let mut recorder = Recorder::new(&mut text);
            for &(want, steps) in &happened {
                recorder.record(wants[want], steps)?;
            }
            drop(recorder);
            let script = Script::parse(&String::from_utf8(text)?, "it").unwrap();
            let each = |&(want, steps): &(usize, u64)| (0..steps).map(move |_| wants[want]);
            prop_assert!(script.iter().map(|(_, intents)| intents).eq(happened.iter().flat_map(each)));
        }
    }

    #[test]
    fn the_header_comes_with_the_first_stretch() {
        let header = Header { seed: Some(7), ..Header::default() };
        let mut text = Vec::new();
        drop(Recorder::with_header(&mut text, header.clone()));
        assert!(text.is_empty());
        Recorder::with_header(&mut text, header).record(Intents::new(), 60).unwrap();
        assert_eq!(String::from_utf8(text).unwrap(), "seed       7\n\n1 s       stand\n");
    }

    #[test]
    fn a_stretch_longer_than_a_line_may_be_takes_several() {
        let mut text = Vec::new();
        Recorder::new(&mut text)
            .record(Intents::new(), 2 * u64::from(Stretch::MOST_STEPS) + 1)
            .unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "3600 s    stand\n3600 s    stand\n1 step    stand\n"
        );
    }
}
