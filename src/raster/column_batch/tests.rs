use std::num::NonZeroU32;

use proptest::prelude::*;

use super::*;
use crate::cast::Side;
use crate::raster::SurfaceBuffer;
use crate::render::Frame;
use crate::visibility::{
    FaceColumn, FrameSize, PixelAspect, Projection, Rows, SideLit, StatsCounter,
};
use crate::world::{Camera, FieldOfView, Heading, Texture};

const HEIGHT: u32 = 90;

/// A column of a wall, or `None`: its distance, its side, and its visible texels.
fn column() -> impl Strategy<Value = Option<(f64, Side, Range<usize>)>> {
    let side = prop::sample::select(&[Side::X, Side::Y][..]);
    let texels = prop::sample::select(&[0..64, 64..128, 0..1, 128..1128, 0..9000][..]);
    prop::option::weighted(0.95, (0.01..20.0, side, texels))
}

/// The bottom and the top of a face.
fn face() -> impl Strategy<Value = (f64, f64)> {
    (-2.0..2.0_f64, 0.0..4.0_f64).prop_map(|(bottom, height)| (bottom, bottom + height))
}

proptest! {
    #[test]
    fn columns_show_their_texels(
        columns in prop::collection::vec(column(), 1..400),
        repeats in 1_usize..20,
    ) {
        let texels: Vec<_> =
            (0..9000).map(|texel| Rgb::new(1, (texel >> 8) as u8, texel as u8)).collect();
        let columns: Vec<_> =
            columns.iter().flat_map(|column| vec![column; repeats]).take(400).collect();
        let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
        let east = Heading::from_degrees(0.0).unwrap();
        let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
        let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
        let mut frame = Frame::new(size, PixelAspect::SQUARE);
        let mut memory = BatchMemory::default();
        let mut surfaces = SurfaceBuffer::default();
        let rows = surfaces.bands(size.height).next().unwrap();
        let mut target = Target::new(frame.whole(), rows, StatsCounter::default());
        let mut batch = ColumnBatch::new(&mut memory, &mut target, false);
        let walls = || (0..).zip(&columns).filter_map(|(x, column)| Some((x, column.as_ref()?)));
        let down = |t: f64, range: &Range<usize>| {
            projection.face_texels(range.len(), (0.0, 1.0)).at(t)
        };
        let rows_of = |t: f64| projection.row_of_height(1.0, t)..projection.row_of_height(0.0, t);
        for (x, (t, side, range)) in walls() {
            let (rows, lighting) = (rows_of(*t), SideLit(*side));
            match texels[range.clone()] {
                [color] => batch.queue_color(x, rows, color, lighting),
                ref texels => batch.queue_texels(x, rows, texels, down(*t, range), lighting),
            }
        }
        batch.draw();
        let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
        for (x, (t, side, range)) in walls() {
            let texels = &texels[range.clone()];
            for row in rows_of(*t) {
                let texel = texels[down(*t, range).at(row)];
                shown[row as usize][x as usize] = SideLit(*side).apply(texel);
            }
        }
        prop_assert!(frame.rows().eq(shown));
    }
    #[test]
    fn faces_repeat_and_crop_their_texels(
        columns in prop::collection::vec((0.1..20.0, 0.0..1.0, face()), 1..200),
        texels in prop::sample::select(&[1_u32, 2, 3, 8, 48, 64, 256, 300][..]),
        side in prop::sample::select(&[Side::X, Side::Y][..]),
        are_direct: bool,
    ) {
        let height = NonZeroU32::new(texels).unwrap();
        let texture = Texture::from_fn(NonZeroU32::new(8).unwrap(), height, |x, y| {
            Rgb::new(x as u8, (y >> 8) as u8, y as u8)
        });
        let level = texture.level(0);
        let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
        let east = Heading::from_degrees(0.0).unwrap();
        let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
        let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
        let faces = || (0..).zip(&columns).filter_map(|(x, &(t, u, heights))| {
            let (bottom, top) = heights;
            let rows = projection.row_of_height(top, t)..projection.row_of_height(bottom, t);
            let texels = projection.face_texels(texels as usize, heights);
            (!rows.is_empty()).then_some((x, rows, (t, u), texels))
        });
        let mut frame = Frame::new(size, PixelAspect::SQUARE);
        let mut memory = BatchMemory::default();
        let mut surfaces = SurfaceBuffer::default();
        let rows = surfaces.bands(size.height).next().unwrap();
        let mut target = Target::new(frame.whole(), rows, StatsCounter::default());
        let mut batch = ColumnBatch::new(&mut memory, &mut target, are_direct);
        let shown: Vec<_> = faces()
            .map(|(x, rows, (t, u), texels)| {
                let rows = Rows { start: rows.start, end: rows.end };
                (x, [FaceColumn { rows, t, u }], texels)
            })
            .collect();
        for &(x, ref columns, texels) in &shown {
            let lighting = SideLit(side);
            batch.draw_columns(&DirectColumns { level, texels, lighting, x, columns });
        }
        batch.draw();
        let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
        for (x, rows, (t, u), texels) in faces() {
            for row in rows {
                let texel = level.column(u)[texels.at(t).at(row)];
                shown[row as usize][x as usize] = SideLit(side).apply(texel);
            }
        }
        prop_assert!(frame.rows().eq(shown));
    }
}
