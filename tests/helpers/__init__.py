"""What tests share: cues, scenes, oracles, made-up files; no tests."""
