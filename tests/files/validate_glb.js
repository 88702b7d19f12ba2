// node validate_glb.js FILE.glb...   The Khronos validator's errors and warnings, one a line; exit 1 when there is one.
const fs = require("fs");
const validator = require("gltf-validator");

const severities = ["error", "warning"];

async function check(file) {
  const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file, maxIssues: 0 });
  const found = report.issues.messages.filter((message) => message.severity < severities.length);
  for (const { severity, code, message, pointer } of found.slice(0, 10)) {
    console.log(`${file}: ${severities[severity]} ${code}: ${message} ${pointer ?? ""}`);
  }
  return found.length;
}

async function main() {
  let problems = 0;
  for (const file of process.argv.slice(2)) problems += await check(file);
  process.exitCode = problems > 0 ? 1 : 0;
}

main();
