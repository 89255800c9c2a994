#!/bin/bash -eu
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
# Never run: OSS-Fuzz was not at hand.
# Builds all fuzzers into $OUT, each with the files that it starts from. OSS-Fuzz sets CC, CXX, CXXFLAGS and
# LIB_FUZZING_ENGINE; the preset's own flags are the same sanitizers.
cd "$SRC/voxplex"
cmake --preset fuzz -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" -DCMAKE_CXX_FLAGS="$CXXFLAGS"
cmake --build --preset fuzz --parallel "$(nproc)" --target fuzzers
/usr/bin/python3 Testing/Fuzz/MakeSeeds.py seeds
for fuzzer in build/fuzz/bin/fuzz-*; do
  name=$(basename "$fuzzer")
  cp "$fuzzer" "$OUT/"
  (cd "seeds/${name#fuzz-}" && zip -q "$OUT/${name}_seed_corpus.zip" ./*)
done
