#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// Runs the Khronos glTF validator on files: node tools/validate_gltf.mjs FILE.glb [FILE.gltf ...]
// Prints every error as FILE: POINTER: MESSAGE [CODE]. Exit code 0: no errors; 1: errors, or a file
// that cannot be read; 2: wrong usage; 3: the validator is not installed (npm ci).
// With --warnings prints warnings too; they never change the exit code.
import { readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

const kError = 0;
const kWarning = 1;

async function load_validator() {
    try {
        return (await import("gltf-validator")).default;
    } catch {
        console.error("gltf-validator is not installed; run: npm ci");
        process.exit(3);
    }
}

async function validate(validator, path, worst) {
    const bytes = new Uint8Array(await readFile(path));
    const folder = dirname(path);
    const report = await validator.validateBytes(bytes, {
        uri: path,
        maxIssues: 0,
        externalResourceFunction: async (uri) =>
            new Uint8Array(await readFile(join(folder, decodeURIComponent(uri)))),
    });
    for (const issue of report.issues.messages) {
        if (issue.severity > worst) continue;
        const kind = issue.severity === kError ? "" : "warning: ";
        console.log(`${path}: ${kind}${issue.pointer ?? ""}: ${issue.message} [${issue.code}]`);
    }
    return report.issues.numErrors;
}

const args = process.argv.slice(2);
const files = args.filter((a) => a !== "--warnings");
if (files.length === 0) {
    console.error("usage: node tools/validate_gltf.mjs [--warnings] FILE.glb [FILE.gltf ...]");
    process.exit(2);
}

const validator = await load_validator();
const worst = files.length === args.length ? kError : kWarning;
let errors = 0;
for (const file of files) {
    try {
        errors += await validate(validator, file, worst);
    } catch (error) {
        console.log(`${file}: ${error.message ?? error}`);
        errors += 1;
    }
}
console.log(`${files.length} files, ${errors} errors`);
process.exit(errors > 0 ? 1 : 0);
