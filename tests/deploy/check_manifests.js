// Checks Kubernetes manifests offline: each by the schema of its kind, and together: selectors choose pods that exist,
// services and policies name ports that containers have, secrets are those that docs/operate.md makes, and no
// container or account may do more than it needs. usage: check_manifests.js FILE.yaml
const fs = require('fs');
const path = require('path');
const yaml = require('js-yaml');

const file = process.argv[2];
const objects = yaml.loadAll(fs.readFileSync(file, 'utf8')).filter(Boolean);
const guide = fs.readFileSync(path.join(__dirname, '../../docs/operate.md'), 'utf8');
const complaints = [];
const name = (o) => `${o.kind} ${o.metadata.name}`;

for (const o of objects) {
  try {
    const Kind = require('kubernetes-models/' + o.apiVersion)[o.kind];
    new Kind(o).validate();
  } catch (error) {
    complaints.push(`${name(o)}: ${error.message}`);
  }
}

const templates = objects.filter((o) => o.spec && o.spec.template).map((o) => ({owner: o, ...o.spec.template}));
const matches = (selector, labels) =>
  Object.entries(selector.matchLabels || {}).every(([k, v]) => labels[k] === v) &&
  (selector.matchExpressions || []).every((e) => e.operator === 'In' && e.values.includes(labels[e.key]));
const chosen = (selector) => templates.filter((t) => matches(selector, t.metadata.labels || {}));
const ports = (t) => t.spec.containers.flatMap((c) => c.ports || []);
const has_port = (pods, port) => pods.some((t) => ports(t).some((p) => p.name === port || p.containerPort === port));

for (const o of objects) {
  if (o.kind === 'Service') {
    const pods = chosen({matchLabels: o.spec.selector});
    for (const p of o.spec.ports) {
      if (!has_port(pods, p.targetPort)) complaints.push(`${name(o)}: nobody listens on ${p.targetPort}`);
    }
  }
  if (o.kind === 'PodDisruptionBudget' && !chosen(o.spec.selector).length) complaints.push(`${name(o)}: chooses no pods`);
  if (o.kind === 'NetworkPolicy' && !chosen(o.spec.podSelector).length) complaints.push(`${name(o)}: is for no pods`);
  if (o.kind === 'NetworkPolicy') {
    for (const rule of o.spec.ingress || []) {
      for (const p of rule.ports || []) {
        if (!has_port(chosen(o.spec.podSelector), p.port)) complaints.push(`${name(o)}: nobody listens on ${p.port}`);
      }
    }
    for (const rule of o.spec.egress || []) {
      // Whoever may ask for names finds who answers, whatever the cluster puts before kube-dns; and of the addresses of
      // a node, one of which tells its secrets, nothing but names is asked.
      const to = rule.to || [];
      const dns = (app) => to.some((t) => t.podSelector && (t.podSelector.matchLabels || {})['k8s-app'] === app);
      const block = (address) => to.some((t) => t.ipBlock && t.ipBlock.cidr === address + '/32');
      if (dns('kube-dns') && !(dns('node-local-dns') && block('169.254.20.10') && block('169.254.169.254'))) {
        complaints.push(`${name(o)}: finds no names where a cache of the node answers`);
      }
      if (to.some((t) => t.ipBlock && t.ipBlock.cidr.startsWith('169.254.')) && !(rule.ports || []).every((p) => p.port === 53)) {
        complaints.push(`${name(o)}: reaches more of its node than names`);
      }
      for (const to of (rule.to || []).filter((t) => t.podSelector && !t.namespaceSelector)) {
        for (const p of rule.ports) {
          if (!has_port(chosen(to.podSelector), p.port)) complaints.push(`${name(o)}: nobody listens on ${p.port}`);
        }
      }
    }
  }
  if (o.kind === 'HorizontalPodAutoscaler') {
    const target = o.spec.scaleTargetRef;
    if (!objects.some((t) => t.kind === target.kind && t.metadata.name === target.name)) complaints.push(`${name(o)}: scales nothing`);
  }
}

// Whether all that an account of these manifests may do in the cluster is to scale deployments that are here.
function may_only_scale(account) {
  const bound = objects.filter((o) => /RoleBinding$/.test(o.kind) && (o.subjects || []).some((s) => s.name === account));
  const here = objects.filter((o) => o.kind === 'Deployment').map((o) => o.metadata.name);
  return objects.some((o) => o.kind === 'ServiceAccount' && o.metadata.name === account) && bound.length > 0 &&
    bound.every((b) => b.kind === 'RoleBinding' && b.roleRef.kind === 'Role' &&
      objects.some((o) => o.kind === 'Role' && o.metadata.name === b.roleRef.name && o.rules.every((r) =>
        r.resources.every((what) => what === 'deployments/scale') &&
        r.verbs.every((verb) => ['get', 'patch'].includes(verb)) &&
        (r.resourceNames || []).length > 0 && r.resourceNames.every((one) => here.includes(one)))));
}

const made = (kind, one) => objects.some((o) => o.kind === kind && o.metadata.name === one);

for (const t of templates) {
  const spec = t.spec;
  const selector = t.owner.spec.selector;
  if (selector && !matches(selector, t.metadata.labels)) complaints.push(`${name(t.owner)}: does not choose its own pods`);
  if (!spec.securityContext.runAsNonRoot) complaints.push(`${name(t.owner)}: may run as root`);
  if (spec.automountServiceAccountToken !== false && !may_only_scale(spec.serviceAccountName)) {
    complaints.push(`${name(t.owner)}: holds a token of the cluster`);
  }
  const prepared = (kind, one) => guide.includes(`${kind} ${one} `);
  for (const v of spec.volumes || []) {
    if (v.secret && !prepared('secret generic', v.secret.secretName) && !prepared('secret tls', v.secret.secretName)) {
      complaints.push(`${name(t.owner)}: docs/operate.md makes no secret ${v.secret.secretName}`);
    }
    if (v.configMap && !made('ConfigMap', v.configMap.name) && !prepared('configmap', v.configMap.name)) complaints.push(`${name(t.owner)}: docs/operate.md makes no configmap ${v.configMap.name}`);
  }
  for (const c of spec.containers) {
    const s = c.securityContext || {};
    if (s.allowPrivilegeEscalation !== false || s.readOnlyRootFilesystem !== true || !((s.capabilities || {}).drop || []).includes('ALL')) {
      complaints.push(`${name(t.owner)}: ${c.name} may do more than it needs`);
    }
    for (const m of c.volumeMounts || []) {
      const claims = (t.owner.spec.volumeClaimTemplates || []).map((v) => v.metadata.name);
      if (!(spec.volumes || []).some((v) => v.name === m.name) && !claims.includes(m.name)) {
        complaints.push(`${name(t.owner)}: there is no volume ${m.name}`);
      }
    }
    // A worker of a Job that is told to leave must not end as one whose work is done: its index would be complete.
    if (t.owner.kind === 'Job' && !(c.args || []).some((a) => /^--exit-status-when-told=[1-9]/.test(a))) {
      complaints.push(`${name(t.owner)}: counts as done when it is evicted`);
    }
    // SIGTERM to SIGKILL is longer than the worker takes to leave.
    const grace = (c.args || []).map((a) => /^--grace=(\d+)$/.exec(a)).find(Boolean);
    if (grace && Number(grace[1]) >= spec.terminationGracePeriodSeconds) complaints.push(`${name(t.owner)}: is killed before its grace is over`);
  }
}

if (complaints.length) {
  console.log(`${file}:\n${complaints.join('\n')}`);
  process.exit(1);
}
console.log(`${path.basename(file)}: ${objects.length} objects are as they should be`);
