//! Events from the terminal.

use super::{KeyEvent, MouseEvent};
use crate::color::palette::ColorDepth;

/// An event of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons pressed or released. Only if
    /// [`Session::set_mouse`](super::Session::set_mouse) has turned on reports.
    Mouse(MouseEvent),
    /// The window has received the focus.
    FocusGained,
    /// The window has lost the focus. Releases of held keys may not be reported.
    FocusLost,
    /// The window may have another size, and the next frame repaints it.
    Resized,
    /// The terminal, or tmux around the program, has answered that it shows this number of colours,
    /// which is not the one assumed before.
    ColorDepth(ColorDepth),
    /// The terminal has said its name, so that
    /// [`Session::glyph_support`](super::Session::glyph_support) and
    /// [`Session::shade_ink`](super::Session::shade_ink) may have changed.
    Identified,
    /// The terminal has answered whether it reports key releases. Sent at most once; before it,
    /// releases are not reported.
    KeyReleases(bool),
    /// Whether [`Session::tell_tmux`](super::Session::tell_tmux) has worked.
    TmuxTold(bool),
    /// The terminal is ready for the next frame. Sent only after
    /// [`Session::is_ready`](super::Session::is_ready) has returned `false`.
    Ready,
    /// The user wants to return to the shell for a while, by Ctrl-Z or a signal. The program should
    /// call [`Session::suspend`](super::Session::suspend).
    Suspend,
    /// The program should end. After a signal, it is ended by force one second later.
    Quit(QuitReason),
}

/// The reason why the program should end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuitReason {
    /// The user pressed Ctrl-C, or the process received SIGINT.
    Interrupted,
    /// The process received SIGTERM.
    Terminated,
    /// The terminal is gone: the process received SIGHUP.
    HungUp,
    /// The input is closed, so that no more keys can arrive.
    InputClosed,
}
