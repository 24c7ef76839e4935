// check_job.mjs FOLDER: holds a Job, given as JSON on the standard input, against the types that Kubernetes publishes; FOLDER has
// kubernetes-models installed. Prints what is wrong, a line each, and ends with 1.
import { readFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

const types = path.resolve(process.argv[2], "node_modules/kubernetes-models");
const { Job } = await import(pathToFileURL(path.join(types, "batch/v1/index.mjs")));
const job = JSON.parse(readFileSync(0, "utf8"));
const wrong = [];

try {
    new Job(job).validate();
} catch (error) {
    wrong.push(error.message);
}

// The schema lets fields pass that it does not know, as Kubernetes would drop them: their names are looked up in the types.
function expectFields(object, type) {
    const text = readFileSync(path.join(types, `${type}.d.ts`), "utf8")
        .replace(/\/\*[^]*?\*\//g, "");  // comments speak of all kinds of things
    for (const field of Object.keys(object))
        if (!new RegExp(`^\\s*"?${field}"?\\??:`, "m").test(text)) wrong.push(`${type} has no field ${field}`);
}
const pod = job.spec.template.spec;
expectFields(job, "batch/v1/Job");
expectFields(job.spec, "batch/v1/JobSpec");
for (const rule of job.spec.podFailurePolicy?.rules ?? []) {
    expectFields(rule, "batch/v1/PodFailurePolicyRule");
    if (rule.onExitCodes) expectFields(rule.onExitCodes, "batch/v1/PodFailurePolicyOnExitCodesRequirement");
    for (const condition of rule.onPodConditions ?? [])
        expectFields(condition, "batch/v1/PodFailurePolicyOnPodConditionsPattern");
}
expectFields(pod, "v1/PodSpec");
if (pod.securityContext) expectFields(pod.securityContext, "v1/PodSecurityContext");
for (const container of pod.containers) {
    expectFields(container, "v1/Container");
    expectFields(container.resources, "v1/ResourceRequirements");
    expectFields(container.securityContext, "v1/SecurityContext");
    for (const mount of container.volumeMounts) expectFields(mount, "v1/VolumeMount");
}
for (const volume of pod.volumes) expectFields(volume, "v1/Volume");

for (const line of wrong) console.log(line);
process.exit(wrong.length > 0 ? 1 : 0);
