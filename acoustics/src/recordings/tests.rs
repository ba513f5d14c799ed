use super::*;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::io::Cursor;

const OGG: &[u8] = include_bytes!("../../tests/data/tone.ogg");
const FLAC: &[u8] = include_bytes!("../../tests/data/tone.flac");

fn tone(rate_hz: u32, frequency_hz: f64, count: usize) -> Vec<f32> {
    let turn = TAU * frequency_hz / f64::from(rate_hz);
    let sample = |k: usize| (0.5 * libm::sin(turn * k as f64)) as f32;
    (0..count).map(sample).collect()
}

fn rms(samples: &[f32]) -> f64 {
    let power: f64 = samples.iter().map(|x| f64::from(*x).powi(2)).sum();
    (power / samples.len() as f64).sqrt()
}

fn wav(bits: u16, float: bool, channels: u16, rate_hz: u32, samples: &[f32]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let spec = hound::WavSpec {
        channels,
        sample_rate: rate_hz,
        bits_per_sample: bits,
        sample_format: if float {
            hound::SampleFormat::Float
        } else {
            hound::SampleFormat::Int
        },
    };
    let mut writer = hound::WavWriter::new(&mut bytes, spec).unwrap();
    let full = (1_i64 << (bits - 1)) as f64;
    for x in samples {
        if float {
            writer.write_sample(*x).unwrap();
        } else {
            writer
                .write_sample((f64::from(*x) * full).round() as i32)
                .unwrap();
        }
    }
    writer.finalize().unwrap();
    bytes.into_inner()
}

/// Samples of 64-bit float, in the plain or the extensible layout.
fn double_wav(channels: u16, rate_hz: u32, samples: &[f32], is_extensible: bool) -> Vec<u8> {
    let frame = 8 * channels;
    let mut layout = Vec::new();
    let kind: u16 = if is_extensible { 0xfffe } else { 3 };
    layout.extend(kind.to_le_bytes());
    layout.extend(channels.to_le_bytes());
    layout.extend(rate_hz.to_le_bytes());
    layout.extend((rate_hz * u32::from(frame)).to_le_bytes());
    layout.extend(frame.to_le_bytes());
    layout.extend(64_u16.to_le_bytes());
    if is_extensible {
        // 22 bytes more: valid bits, the mask of channels, and the identifier, which begins with the kind.
        layout.extend([22, 0, 64, 0, 0, 0, 0, 0, 3, 0]);
        layout.extend([0; 14]);
    }
    let data: Vec<u8> = samples
        .iter()
        .flat_map(|x| f64::from(*x).to_le_bytes())
        .collect();
    let mut body = b"WAVE".to_vec();
    for (name, content) in [(b"fmt ", layout), (b"LIST", vec![0; 6]), (b"data", data)] {
        body.extend(name);
        body.extend((content.len() as u32).to_le_bytes());
        body.extend(content);
    }
    let mut file = b"RIFF".to_vec();
    file.extend((body.len() as u32).to_le_bytes());
    file.extend(body);
    file
}

fn refusal(bytes: &[u8]) -> String {
    let message = Recording::decode("bell", bytes).unwrap_err().to_string();
    assert!(message.starts_with("bell: "), "{message}");
    message
}

#[test]
fn every_kind_of_wav_gives_its_samples_back() {
    let samples = tone(22_050, 700.0, 3_000);
    for (bits, float, step) in [
        (8, false, 1.0 / 128.0),
        (16, false, 1.0 / 32_768.0),
        (24, false, 1e-6),
        (32, false, 1e-7),
        (32, true, 0.0),
    ] {
        let file = Recording::decode("bell", &wav(bits, float, 1, 22_050, &samples)).unwrap();
        assert_eq!((file.rate_hz(), file.channels()), (22_050, 1));
        assert_eq!(file.samples().len(), samples.len());
        for (found, wanted) in file.samples().iter().zip(&samples) {
            assert!((found - wanted).abs() <= 0.51 * step, "{bits} {float}");
        }
    }
}

/// As players, recorders and `libsndfile` write them: the byte of padding is not counted in a chunk's length.
#[test]
fn chunks_of_odd_length_before_the_samples_are_padded() {
    let samples = tone(22_050, 700.0, 3_000);
    let plain = wav(16, false, 1, 22_050, &samples);
    let expected = Recording::decode("bell", &plain).unwrap();
    // The header and the format of hound's plain layout.
    let (head, data) = plain.split_at(36);
    assert!(data.starts_with(b"data"));
    let odd = [
        &b"LIST"[..],
        &15_u32.to_le_bytes(),
        b"INFOISFT\x03\0\0\0abc",
    ]
    .concat();
    let even = [&b"junk"[..], &2_u32.to_le_bytes(), b"ab"].concat();
    let (format, start) = (&head[12..], &head[..12]);
    for chunks in [
        [start, format, &odd, b"\0", data].concat(),
        [start, &odd, b"\0", format, &odd, b"\0", &even, data].concat(),
        // Without the padding, which is wrong and has always been read.
        [start, format, &odd, data].concat(),
    ] {
        assert_eq!(Recording::decode("bell", &chunks).unwrap(), expected);
    }
    // A file that ends in such a chunk is damaged.
    for end in [&odd[..6], &odd[..12], &odd] {
        let cut = [start, format, end].concat();
        assert!(refusal(&cut).contains("undamaged"), "{}", refusal(&cut));
    }
}

/// What programs write that reckon with NumPy; once an "ill-formed" file.
#[test]
fn doubles_give_the_samples_of_floats() {
    let samples = tone(22_050, 700.0, 3_000);
    let floats = Recording::decode("bell", &wav(32, true, 2, 22_050, &samples)).unwrap();
    for is_extensible in [false, true] {
        let file = double_wav(2, 22_050, &samples, is_extensible);
        assert_eq!(Recording::decode("bell", &file).unwrap(), floats);
        for cut in [1, 8, 100] {
            assert!(refusal(&file[..file.len() - cut]).contains("undamaged"));
        }
        assert!(refusal(&file[..60]).contains("undamaged"));
    }
    let wrong = double_wav(1, 22_050, &[0.1, f32::NAN], false);
    assert!(refusal(&wrong).contains("sample 1: found NaN"));
    assert!(refusal(&double_wav(0, 22_050, &samples, false)).contains("1 to 64"));
    // A-law.
    let mut other = wav(8, false, 1, 16_000, &samples);
    other[20] = 6;
    let message = refusal(&other);
    assert!(message.contains("float of 32 and 64"), "{message}");
}

#[test]
fn channels_are_mixed_to_their_mean() {
    let pairs: Vec<f32> = tone(16_000, 500.0, 800)
        .into_iter()
        .flat_map(|x| [x, 0.0, -0.5 * x])
        .collect();
    let file = Recording::decode("bell", &wav(32, true, 3, 16_000, &pairs)).unwrap();
    let wanted = tone(16_000, 500.0, 800);
    assert_eq!(file.channels(), 3);
    for (found, wanted) in file.samples().iter().zip(wanted) {
        assert!((found - wanted / 6.0).abs() < 1e-7);
    }
}

/// The two files were encoded by libFLAC and libvorbis from a tone of 500 Hz, amplitude 0.5 on the left, 0.25 on the right.
#[test]
fn flac_and_vorbis_hold_the_tone_that_was_encoded() {
    for (bytes, most) in [(FLAC, 1e-6), (OGG, 0.02)] {
        let file = Recording::decode("tone", bytes).unwrap();
        assert_eq!((file.rate_hz(), file.channels()), (16_000, 2));
        assert_eq!(file.samples().len(), 8_000);
        for (k, found) in file.samples().iter().enumerate() {
            let wanted = 0.375 * libm::sin(TAU * 500.0 * k as f64 / 16_000.0);
            assert!((f64::from(*found) - wanted).abs() < most, "{k}: {found}");
        }
    }
}

#[test]
fn the_level_is_one_pascal_whatever_the_file_holds() {
    for size in [0.001, 0.9] {
        let samples: Vec<f32> = tone(44_100, 440.0, 44_100)
            .iter()
            .map(|x| size * x)
            .collect();
        let file = Recording::decode("bell", &wav(32, true, 1, 44_100, &samples)).unwrap();
        for rate_hz in [8_000, 16_000, 44_100, 48_000] {
            let signal = file.signal(rate_hz).unwrap();
            assert_eq!(signal.samples().len(), rate_hz as usize);
            assert!((rms(signal.samples()) - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn a_resampled_tone_is_that_tone() {
    for (from, to) in [
        (44_100, 16_000),
        (8_000, 16_000),
        (48_000, 44_100),
        (16_001, 16_000),
        (768_000, 8_000),
    ] {
        let nyquist = 0.5 * f64::from(from.min(to));
        for share in [0.01, 0.3, 0.89] {
            let found = resample(&tone(from, share * nyquist, from as usize / 2), from, to);
            let wanted = tone(to, share * nyquist, to as usize / 2);
            assert_eq!(found.len(), wanted.len());
            // Away from the ends, where the tone begins and breaks off.
            let inside = wanted.len() / 4..3 * wanted.len() / 4;
            let worst = inside
                .map(|k| (found[k] - wanted[k]).abs())
                .fold(0.0, f32::max);
            assert!(worst < 5e-5, "{from} to {to}, {share}: {worst}");
        }
    }
}

#[test]
fn nothing_is_folded_into_a_lower_rate() {
    for frequency_hz in [8_000.0, 9_000.0, 15_000.0, 21_000.0] {
        let found = resample(&tone(48_000, frequency_hz, 48_000), 48_000, 16_000);
        let level_db = 20.0 * libm::log10(rms(&found[4_000..12_000]) / (0.5 / 2.0_f64.sqrt()));
        assert!(level_db < -90.0, "{frequency_hz}: {level_db} dB");
    }
    let same = tone(16_000, 100.0, 999);
    assert_eq!(resample(&same, 16_000, 16_000), same);
}

#[test]
fn what_is_no_sound_is_refused_with_what_is_allowed() {
    assert!(refusal(b"ID3 mp3").contains("WAV (\"RIFF\"), FLAC"));
    assert!(refusal(b"").contains("begins with"));
    assert!(refusal(b"RIFF").contains("undamaged"));
    let silent = refusal(&wav(16, false, 1, 16_000, &[0.0; 100]));
    assert!(silent.contains("100 samples of silence"), "{silent}");
    assert!(refusal(&wav(16, false, 1, 16_000, &[])).contains("silence"));
    for wrong in [f32::NAN, f32::INFINITY, 1e30] {
        let message = refusal(&wav(32, true, 1, 16_000, &[0.1, wrong]));
        assert!(message.contains("sample 1: found"), "{message}");
        assert!(message.contains("finite numbers"), "{message}");
    }
    assert!(refusal(&wav(16, false, 1, 999, &[0.1; 10])).contains("1000 to 768000"));
    assert!(refusal(&wav(16, false, 65, 16_000, &[0.1; 65])).contains("1 to 64"));
    // Header fields by hand: channels at 22, rate at 24, length of the data at 40.
    let good = wav(16, false, 1, 16_000, &[0.1; 10]);
    let with = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        file
    };
    refusal(&with(22, &[0, 0]));
    refusal(&with(24, &[0; 4]));
    refusal(&with(40, &2_000_000_000_u32.to_le_bytes()));
    assert!(Recording::decode("bell", &good).is_ok());
}

#[test]
fn files_that_break_off_are_refused() {
    let samples = tone(16_000, 440.0, 4_000);
    for whole in [&wav(24, false, 1, 16_000, &samples)[..], FLAC, OGG] {
        for share in [2, 3, 10] {
            refusal(&whole[..whole.len() - whole.len() / share]);
        }
        refusal(&whole[..whole.len() - 1]);
    }
}

#[test]
fn more_samples_than_allowed_are_refused_before_they_are_made() {
    let file = Recording::decode("bell", &wav(16, false, 1, 1_000, &vec![0.1; 200_000])).unwrap();
    assert_eq!(file.duration_s(), 200.0);
    let message = file.signal(192_000).unwrap_err().to_string();
    assert!(message.contains("38400000"), "{message}");
    assert!(file.signal(500).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn mutated_files_give_a_sound_or_an_error(
        which in 0_usize..4,
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        head in any::<bool>(),
    ) {
        let samples = tone(16_000, 440.0, 400);
        let mut bytes = match which {
            0 => wav(16, false, 2, 16_000, &samples),
            1 => FLAC.to_vec(),
            3 => double_wav(2, 16_000, &samples, true),
            _ => OGG.to_vec(),
        };
        // Headers are where claims stand.
        let reach = if head { bytes.len().min(200) } else { bytes.len() };
        for (place, value) in edits {
            let at = place.index(reach);
            bytes[at] = value;
        }
        if let Ok(file) = Recording::decode("bell", &bytes) {
            prop_assert!(file.samples().iter().all(|x| x.is_finite()));
        }
    }
}
