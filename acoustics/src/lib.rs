//! What a microphone hears: rays, band materials, impulse responses.
