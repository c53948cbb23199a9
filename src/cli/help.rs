//! What `--help` prints: enough to use the program.

use std::io::{self, Write};

use super::Error;

pub(super) fn print() -> Result<(), Error> {
    write(HELP)
}

pub(super) fn print_version() -> Result<(), Error> {
    write(concat!("cellcaster ", env!("CARGO_PKG_VERSION"), "\n"))
}

fn write(text: &str) -> Result<(), Error> {
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

const HELP: &str = r##"cellcaster: a raycaster game in the terminal, and its pictures in scripts

USAGE
  cellcaster [play] [MAP] [OPTIONS]    play; without MAP, the built-in levels
  cellcaster snapshot [MAP] [OPTIONS]  one frame to standard output
  cellcaster cast [MAP] [OPTIONS]      rays from standard input, hits to standard output
  cellcaster check MAP...              say everything that is wrong with maps
  cellcaster config [--config FILE]    the settings in force, as a file with comments
  cellcaster accuracy [MAP] [OPTIONS]  error against run time, for every way to cast
  cellcaster bench [OPTIONS]           how fast this machine draws, and a link shows it
  cellcaster replay SCRIPT [MAP] [OPTIONS]  a script, off screen, as asciicast
  cellcaster wire [MAP] [OPTIONS]      bytes a frame against what the viewer sees
  cellcaster --help | --version

  MAP is a map file, or a built-in level: cellar, museum, citadel,
  cistern, observatory; --generate maze, cave or office digs one in its place.

KEYS
  W S, Up Down      walk                M, Tab  show or hide the map
  A D               strafe              + -     field of view
  Left Right        turn                PgUp PgDn, Home   look up, down, ahead
  Shift             run                 P       pause
  R                 run, on and off     I       show frames and link
  E, Space          open a door         ?       help
  Space             jump                Q, Esc  leave
  C                 duck, X: on and off 9 3, 8 4 6 2, 5  zoom the map, move it, back

OPTIONS OF PLAY
  --fps N           at most N frames a second, 1 to 240            [30]
  --config FILE     keys and settings   [cellcaster/config.toml in the
                    folder for configuration files]
  --fidelity LEVEL  how exact colours are while something moves: auto (as the
                    link allows), exact, high, low or 0 to 255     [auto]
  --stats           show frames and bytes a second, round trip and fidelity
  --record FILE     a FILE.cast: what the terminal is sent, as asciicast v3;
                    any other: what you do, as a script for replay and wire

OPTIONS OF SNAPSHOT
  --size COLSxROWS  cells, 1x1 to 4096x4096                        [80x24]
  --camera X,Y,HEADING
                    where to look from, in cells and degrees: 0 is east,
                    90 south                                       [the map's start]
  --eye HEIGHT      in cells above floor level                     [0.5]
  --pitch DEG       look down, from -30, or up, to 30              [0]
  --format FORMAT   text: characters; ansi: with colours; json; png  [text]
  --explain         how the frame is drawn and what it costs, in its place

OPTIONS OF BOTH
  --fov DEG         field of view, above 0, below 180              [66]
  --cell-aspect H   height of a cell over its width, 0.1 to 10     [2.0, or what
                    the terminal says]
  --glyphs MODE     half: two pixels a cell; ascii: one, as a character;
                    ramp: one, as a character for its brightness   [half]
  --colors DEPTH    true, 256, 16 or mono           [true, or what the terminal has]
  --filter FILTER   mip: far textures are averaged; nearest: raw texels  [mip]

  --caster METHOD   also of cast: how walls are found               [exact]
                    exact, dda, dda32, accumulate, fixed:BITS, table:ANGLES
                    or march:STEP

OPTIONS OF LEVELS TO DIG, for play, snapshot and replay
  --generate KIND   maze, cave or office, in place of MAP
  --seed N          which one                                      [1]
  --level-size COLSxROWS
                    with walls around, and an exit                 [without an end]
  --start COLUMN,ROW
                    the cell to start at                           [the first corner]

CAST
  Reads one ray a line, "X Y DX DY", and writes one JSON object a line:
  {"cell":[c,r],"side":"x","t":1.5,"u":0.25,"tile":"#"}, {"escaped":true} for a
  ray that leaves the map, or {"error":"..."} for a line that is no ray.

ACCURACY
  --caster METHOD   report on this method; may be repeated         [all]
  --set NAME        rays of one set, such as "through corners"     [three scenes,
                    and then every stiff and extreme set; in MAP if one is given]
  --rays N          rays in each scene, 1 to 10000000              [2000]
  --seed S          where chance begins                            [1]
  --format FORMAT   table, json, csv, svg or png                   [table]

BENCH
  --seconds N       how long to measure, 1 to 60; preparing comes on top  [10]
  --format FORMAT   table, markdown or json                        [table]
  --plot FILE       draw plots of it, besides, as SVG

REPLAY, WIRE
  --cast FILE       of replay: where to write                      [standard output]
  --script FILE     of wire: what is played                        [a walk in citadel]
  --format FORMAT   of wire: table, json or csv                    [table]
  --size, --fps     as above        [80x24 for replay, 120x40 for wire; 30]
  --fov, --colors   of replay, as above                            [66; true]
  --fidelity LEVEL  exact, high, low or 0 to 255: how far colours may be off
                    [exact for replay; for wire, which takes several, the named]
  A script is lines such as "2.5 s forward run" or "12 steps turn-left open";
  "stand" is nothing, [walking] begins a section, # a comment.

EXAMPLES
  cellcaster                                   play the built-in levels
  cellcaster play --generate maze --seed 7     walk through a maze without an end
  cellcaster my.toml --colors 256              play a map of your own
  ssh -t host cellcaster                       play it somewhere else
  cellcaster snapshot museum --format ansi     a picture in the terminal
  cellcaster snapshot my.toml --size 120x40 --format png > my.png
  echo "1.5 1.5 1 0" | cellcaster cast my.toml
  cellcaster check maps/*.toml
  cellcaster accuracy --caster exact --caster dda --set "through corners"
  cellcaster accuracy --format svg > accuracy.svg
  cellcaster bench                             what to expect of this machine
  cellcaster bench --format json > bench.json
  cellcaster --record walk.script && cellcaster replay walk.script > walk.cast

Exit status: 0, or 2 for a mistake in the arguments or a map, or 1 where the
machine refuses something.
"##;
