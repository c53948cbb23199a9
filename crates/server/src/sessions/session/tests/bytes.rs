//! The number of bytes per frame, for exact and approximate pictures, with and without compression.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::*;
use crate::config::Config;
use crate::rooms::room::Catalog;
use cellcaster::color::palette::ColorDepth;
use cellcaster::terminal::Fidelity;

/// The frames of a walk through the museum.
fn walk(fidelity: Fidelity) -> Vec<Vec<u8>> {
    let catalog = Catalog::builtin();
    let mut rig = Rig::with(RigOptions { catalog, level: "museum", ..RigOptions::new(Mode::Roam) });
    rig.live.replace(Config { player_bytes_per_second: 0, ..Config::default() });
    let one = rig.visitor_with("Mara", (80, 24), Speaks::Kitty, ColorDepth::True);
    rig.session(one, move |session, _| session.protocol.set_fidelity(Some(fidelity)));
    for _ in 0..3 {
        rig.press(one, ENTER);
    }
    let begun = rig.now();
    for turn in ["\x1b[1;1:1C", "\x1b[1;1:3C", "\x1b[1;1:1D", "\x1b[1;1:3D"] {
        rig.send(one, "\x1b[119;1:1u");
        rig.send(one, turn);
        rig.pump(1_000);
    }
    rig.clients[one].received(begun)
}

fn compressed(frames: &[Vec<u8>]) -> usize {
    let mut stream = ZlibEncoder::new(Vec::new(), Compression::fast());
    for frame in frames {
        stream.write_all(frame).unwrap();
        stream.flush().unwrap();
    }
    stream.finish().unwrap().len()
}

#[test]
fn compressed_exact_frames_are_smaller_than_coarse_ones() {
    let of = |frames: &[Vec<u8>]| frames.iter().map(Vec::len).sum::<usize>() / frames.len();
    let [exact, high] = [Fidelity::EXACT, Fidelity::HIGH].map(walk);
    assert!(exact.len() > 60 && high.len() > 60, "{} {}", exact.len(), high.len());
    let packed = compressed(&exact) / exact.len();
    let found = format!("exact {}, compressed {packed}, high {}", of(&exact), of(&high));
    println!("bytes a frame: {found}");
    assert!(packed * 2 < of(&exact), "{found}");
    assert!(packed < of(&high) * 3 / 2, "{found}");
}
