//! A ratatui program with Cellcaster's encoder as its backend: `cargo run --example backend | wc
//! -c`.

use std::io::{self, Write};

use cellcaster::terminal::{CellWriter, Fidelity};
use ratatui::Terminal;
use ratatui::layout::Size;
use ratatui::style::Color;
use ratatui::widgets::Block;

fn main() -> io::Result<()> {
    let size = Size::new(40, 10);
    let mut backend = CellWriter::new(io::stdout().lock(), size);
    backend.set_fidelity(Fidelity::HIGH);
    let mut terminal = Terminal::new(backend)?;
    for brightness in 0..=255 {
        let color = Color::Rgb(brightness, brightness / 2, 64);
        terminal.draw(|frame| {
            let block = Block::bordered().title("Cellcaster").style((Color::White, color));
            frame.render_widget(block, frame.area());
        })?;
    }
    let bytes = terminal.backend().bytes_written();
    drop(terminal);
    writeln!(io::stderr(), "{bytes} bytes")
}
