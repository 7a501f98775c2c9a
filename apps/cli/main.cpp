// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

int main(int argc, char** argv) { return aglow::cli::run({argv + 1, argv + argc}); }
