//! Files of films: GIF, numbered PNG pictures in a folder, or MP4 by ffmpeg.

use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use maulstick_appearance::picture::Picture;
use maulstick_exchange::film::GifFilm;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, check_folder, ending, write_folder, write_whole, write_whole_at};

use maulstick_painting_setup::outputs::{UsedFile, check_outputs};

/// Program that encodes video.
const FFMPEG: &str = "ffmpeg";
/// Pixels of the longer side of a film, unless its width is given.
const SIDE: usize = 1920;
/// The same of a GIF, which has no good compression.
const GIF_SIDE: usize = 640;

/// Kind of the file of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FilmKind {
    /// MP4, by ffmpeg.
    Mp4,
    Gif,
    /// Folder of numbered PNG pictures.
    Pictures,
}

impl FilmKind {
    /// Kind of a file by its name.
    ///
    /// # Errors
    /// A [`UserError`] for the name of another kind.
    pub(super) fn of(path: &Path) -> Result<Self, UserError> {
        match ending(path).as_str() {
            "" => Ok(Self::Pictures),
            "gif" => Ok(Self::Gif),
            "mp4" => Ok(Self::Mp4),
            _ if path.as_os_str().as_encoded_bytes().ends_with(b"/") => Ok(Self::Pictures),
            ending => Err(UserError::usage(format!("no film ends in .{ending}"))
                .at(path.display().to_string())
                .help("end it in .mp4 or .gif, or name a new folder for PNG pictures")),
        }
    }

    /// Pixels of the longer side, unless the width is given.
    pub(super) fn side(self) -> usize {
        match self {
            Self::Gif => GIF_SIDE,
            Self::Mp4 | Self::Pictures => SIDE,
        }
    }
}

/// Receiver of the frames of a film.
type Add<'a> = dyn FnMut(&Picture) -> Result<(), UserError> + 'a;

/// File of a film that can be written.
#[derive(Debug)]
pub(super) struct FilmFile {
    kind: FilmKind,
    path: PathBuf,
    fps: u32,
}

impl FilmFile {
    /// Checks, before the work that fills it, that a film of `painting` can be written.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot, or where ffmpeg is missing.
    pub(super) fn new(
        kind: FilmKind,
        path: &Path,
        painting: &Path,
        fps: u32,
    ) -> Result<Self, UserError> {
        let output = UsedFile::new("the film", path);
        let inputs = [UsedFile::painting(painting)];
        match kind {
            FilmKind::Mp4 => {
                check_outputs(&[output.of(Kind::Mp4)], &inputs)?;
                let version = Command::new(FFMPEG)
                    .arg("-version")
                    .stdin(Stdio::null())
                    .stdout(Stdio::null())
                    .stderr(Stdio::null())
                    .status();
                version.map_err(|error| no_ffmpeg(&error))?;
            }
            FilmKind::Gif => check_outputs(&[output.of(Kind::Gif)], &inputs)?,
            FilmKind::Pictures => {
                check_folder(path).map_err(|error| UserError::writing(path, &error))?;
            }
        }
        Ok(Self {
            kind,
            path: path.to_owned(),
            fps,
        })
    }

    /// Writes a film of frames of this size from `fill`, completely or not at all.
    ///
    /// # Errors
    /// The error of `fill`, or where the film cannot be written.
    pub(super) fn write(
        &self,
        size: [usize; 2],
        fill: impl FnOnce(&mut Add<'_>) -> Result<(), UserError>,
    ) -> Result<(), UserError> {
        let path = &self.path;
        let mut failed = None;
        let mut told = |filled: Result<(), UserError>| {
            filled.map_err(|error| {
                failed = Some(error);
                Error::other("not written")
            })
        };
        let written = match self.kind {
            FilmKind::Gif => write_whole(path, Kind::Gif, |file| {
                let mut gif = GifFilm::new(file, size)?;
                let mut number = 0;
                let time = |frame: u64| 100 * frame / u64::from(self.fps);
                told(fill(&mut |picture| {
                    number += 1;
                    let shown = time(number) - time(number - 1);
                    gif.add(&picture.rgb, shown as u16)
                        .map_err(|error| UserError::writing(path, &error))
                }))?;
                gif.end()
            }),
            FilmKind::Pictures => write_folder(path, |folder| {
                let mut number = 0;
                told(fill(&mut |picture| {
                    number += 1;
                    let name = folder.join(format!("{number:05}.png"));
                    let file = File::create(name).map(BufWriter::new);
                    file.and_then(|file| picture.encode_png(file))
                        .map_err(|error| UserError::writing(path, &error))
                }))
            }),
            FilmKind::Mp4 => write_whole_at(path, Kind::Mp4, |to| {
                let mut video = Video::begin(to, size, self.fps)?;
                told(fill(&mut |picture| {
                    let added = video.add(&picture.rgb);
                    added.map_err(|error| UserError::writing(path, &error))
                }))?;
                video.end()
            }),
        };
        match failed {
            Some(error) => Err(error),
            None => written.map_err(|error| UserError::writing(path, &error)),
        }
    }
}

fn no_ffmpeg(error: &Error) -> UserError {
    let what = match error.kind() {
        ErrorKind::NotFound => "ffmpeg is not installed".to_owned(),
        _ => format!("ffmpeg cannot be started: {error}"),
    };
    UserError::failure(what).help(
        "install it with your system's packages, or end the name in .gif, or name a new folder for PNG pictures",
    )
}

/// A video that ffmpeg encodes.
struct Video {
    ffmpeg: Child,
    /// Its messages about errors.
    said: File,
}

impl Video {
    /// Begins a video of frames of this size, pixels across and down, in BT.709, which players assume.
    fn begin(to: &Path, size: [usize; 2], fps: u32) -> Result<Self, Error> {
        let said = tempfile::tempfile()?;
        let [width, height] = size;
        let input = ["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size"];
        let colours = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p,\
                       setparams=colorspace=bt709:color_primaries=bt709:color_trc=bt709";
        let output = [
            "-an",
            "-vf",
            colours,
            "-c:v",
            "libx264",
            "-crf",
            "18",
            "-preset",
            "medium",
            "-movflags",
            "+faststart",
            "-f",
            "mp4",
        ];
        let ffmpeg = Command::new(FFMPEG)
            .args(["-hide_banner", "-nostdin", "-loglevel", "error", "-y"])
            .args(input)
            .arg(format!("{width}x{height}"))
            .args(["-framerate", &fps.to_string(), "-i", "pipe:0"])
            .args(output)
            // Else a name may be an option, or a protocol.
            .arg({
                let mut name = std::ffi::OsString::from("file:");
                name.push(to);
                name
            })
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(said.try_clone()?)
            .spawn()?;
        Ok(Self { ffmpeg, said })
    }

    fn add(&mut self, rgb: &[u8]) -> Result<(), Error> {
        let written = match &mut self.ffmpeg.stdin {
            Some(pipe) => pipe.write_all(rgb),
            None => Ok(()),
        };
        match written {
            // It has ended, with a reason.
            Err(error) if error.kind() == ErrorKind::BrokenPipe => self.end(),
            written => written,
        }
    }

    /// Waits until the video is written.
    fn end(&mut self) -> Result<(), Error> {
        drop(self.ffmpeg.stdin.take());
        if self.ffmpeg.wait()?.success() {
            return Ok(());
        }
        let mut said = String::new();
        self.said.rewind()?;
        self.said.read_to_string(&mut said)?;
        let last = said.lines().last().unwrap_or("it failed");
        Err(Error::other(format!("ffmpeg: {last}")))
    }
}

impl Drop for Video {
    fn drop(&mut self) {
        // It may have ended already.
        self.ffmpeg.kill().ok();
        self.ffmpeg.wait().ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_says_which_film_it_is() {
        for (name, kind) in [
            ("a/film.mp4", FilmKind::Mp4),
            ("film.GIF", FilmKind::Gif),
            ("frames", FilmKind::Pictures),
            ("sea.maul.frames/", FilmKind::Pictures),
        ] {
            assert_eq!(
                FilmKind::of(Path::new(name)).expect("known"),
                kind,
                "{name}"
            );
        }
        let unknown = FilmKind::of(Path::new("film.avi")).expect_err("unknown");
        let text = unknown.to_string();
        assert!(text.contains(".mp4") && text.contains(".gif"), "{text}");
    }

    #[test]
    fn a_film_is_whole_or_not_there() {
        let folder = tempfile::tempdir().expect("a folder");
        let picture = |value: u8| Picture::srgb(4, 2, vec![value; 24]);
        for name in ["film.gif", "frames"] {
            let path = folder.path().join(name);
            let kind = FilmKind::of(&path).expect("known");
            let film = || FilmFile::new(kind, &path, Path::new("a.maul"), 30);
            let half = film().expect("writable").write([4, 2], |add| {
                add(&picture(1))?;
                Err(UserError::failure("stopped"))
            });
            assert!(half.expect_err("told").to_string().contains("stopped"));
            assert!(!path.exists());
            let fill = |add: &mut Add<'_>| (0..9).try_for_each(|value| add(&picture(value)));
            film()
                .expect("writable")
                .write([4, 2], fill)
                .expect("written");
            assert!(path.exists());
            // Only a film is replaced, and no folder with files.
            assert_eq!(film().is_ok(), kind == FilmKind::Gif);
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 2);
        let frames = std::fs::read_dir(folder.path().join("frames")).expect("there");
        assert_eq!(frames.count(), 9);
    }
}
