//! What the terminal tells the program.

use super::{KeyEvent, MouseEvent};
use crate::color::palette::ColorDepth;

/// Something that happened to the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons pressed: while
    /// [`Session::set_mouse`](super::Session::set_mouse) has it reported.
    Mouse(MouseEvent),
    /// What is typed goes to this window again.
    FocusGained,
    /// What is typed goes elsewhere from now on. Keys that are held may be released unheard.
    FocusLost,
    /// The window may have another size, and everything is painted again by the next frame.
    Resized,
    /// The terminal has said that it shows this many colours, which is more than was guessed.
    ColorDepth(ColorDepth),
    /// The terminal has agreed, or not, to report when keys are released. Sent at most once; until
    /// then, releases are not reported.
    KeyReleases(bool),
    /// The terminal is ready for the next frame. Sent only after
    /// [`Session::is_ready`](super::Session::is_ready) has denied it.
    Ready,
    /// The user wants to go back to the shell for a while: Ctrl-Z, or a signal. The program is
    /// asked to call [`Session::suspend`](super::Session::suspend).
    Suspend,
    /// The program is asked to end. After a signal, it is ended by force one second later.
    Quit(QuitReason),
}

/// Why the program is asked to end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuitReason {
    /// The user pressed Ctrl-C, or somebody sent the signal that it stands for.
    Interrupted,
    /// A signal said so.
    Terminated,
    /// The terminal is gone, says a signal.
    HungUp,
    /// There will be no more keys.
    InputClosed,
}
