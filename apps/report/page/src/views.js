import { Color, Group, Mesh, PerspectiveCamera, Raycaster, Scene as Stage, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { fillGeometry, needsOwnCorners, patchGeometry, patchMaterial } from './shading.js';

const background = new Color('#14171d');
const markColour = '#ff2d95';

/// The segments [a, b, a, b, …] of vertex numbers as a fat line.
function segments(cycle, ends, material) {
  const points = [];
  for (const v of ends) points.push(...cycle.positions.subarray(3 * v, 3 * v + 3));
  return new LineSegments2(new LineSegmentsGeometry().setPositions(points), material);
}

/// One canvas: a cycle's patches, the lines on them, the patch that was asked for.
class Side {
  constructor(canvas, material, lineMaterials, smooth) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: smooth, powerPreference: 'low-power' });
    this.stage = new Stage();
    this.stage.background = background;
    this.mesh = new Mesh(undefined, material);
    this.mesh.frustumCulled = false;
    this.lines = new Group();
    this.mark = new Group();
    this.lineMaterials = lineMaterials;
    this.markMaterial = new LineMaterial({ color: markColour, linewidth: 3, depthTest: false });
    this.stage.add(this.mesh, this.lines, this.mark);
  }

  show(cycle, look, shot) {
    const ownCorners = needsOwnCorners(look);
    if (cycle !== this.cycle || ownCorners !== this.ownCorners) {
      this.ownCorners = ownCorners;
      this.mesh.geometry.dispose();
      this.mesh.geometry = patchGeometry(cycle, ownCorners);
    }
    if (cycle !== this.cycle) {
      this.cycle = cycle;
      for (const old of this.lines.children) old.geometry?.dispose();
      this.lines.clear();
      cycle.lines.forEach((ends, kind) => {
        const drawn = ends.length > 0 ? segments(cycle, ends, this.lineMaterials[kind]) : new Group();
        drawn.renderOrder = 1;
        this.lines.add(drawn);
      });
      this.markPatch(null);
    }
    fillGeometry(this.mesh.geometry, cycle, look, shot);
    this.lines.children.forEach((drawn, kind) => { drawn.visible = look.kinds.has(kind); });
  }

  markPatch(patch) {
    for (const old of this.mark.children) old.geometry.dispose();
    this.mark.clear();
    if (patch === null) return;
    const [a, b, c] = this.cycle.corners.subarray(3 * patch, 3 * patch + 3);
    const outline = segments(this.cycle, [a, b, b, c, c, a], this.markMaterial);
    outline.renderOrder = 2;
    this.mark.add(outline);
  }
}

/// The two views and their one camera.
export class Views {
  /// `smooth`: whether edges are antialiased; slow on large meshes without graphics hardware. `onPick` gets the
  /// patch of each side at the place asked for, null where there is none.
  constructor({ canvases, scene, lineKinds, smooth, onPick }) {
    this.scene = scene;
    this.onPick = onPick;
    this.material = patchMaterial();
    const lineMaterials = lineKinds.map(({ color }) => new LineMaterial({ color, linewidth: 2.5 }));
    this.sides = canvases.map((canvas) => new Side(canvas, this.material, lineMaterials, smooth));
    this.camera = new PerspectiveCamera(40, 1, scene.diameter * 1e-3, scene.diameter * 100);
    this.target = new Vector3();
    this.raycaster = new Raycaster();
    for (const side of this.sides) {
      this.listen(side);
      new ResizeObserver(() => this.resize()).observe(side.canvas.parentElement);
    }
  }

  /// Puts the camera where a view of the scene has it. It turns about what lies in its middle.
  lookFrom(view) {
    this.view = view;
    const forward = new Vector3(...view.forward);
    this.camera.position.set(...view.from);
    this.camera.up.set(...view.up);
    const centre = -this.camera.position.dot(forward);  // the scene's centre is the origin
    this.target.copy(this.camera.position).addScaledVector(forward, Math.max(centre, 0.1 * this.scene.diameter));
    this.camera.lookAt(this.target);
    for (const side of this.sides) {
      side.controls?.dispose();
      side.controls = new OrbitControls(this.camera, side.canvas);
      side.controls.target = this.target;
      side.controls.enableKeys = false;
      side.controls.addEventListener('change', () => this.draw());
    }
    this.resize();
  }

  resize() {
    if (!this.view) return;
    const box = this.sides[0].canvas.parentElement;
    const width = Math.max(box.clientWidth, 1), height = Math.max(box.clientHeight, 1);
    for (const side of this.sides) {
      side.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
      side.renderer.setSize(width, height, false);
    }
    // What the view shows stays in a canvas that is narrower than it.
    const half = Math.tan((this.view.vertical_fov * Math.PI) / 360);
    const narrow = Math.max(1, (this.view.aspect || 1) * (height / width));
    this.camera.fov = (Math.atan(half * narrow) * 360) / Math.PI;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /// Soon, once for all that changed.
  draw() {
    this.waiting ??= requestAnimationFrame(() => {
      this.waiting = undefined;
      this.drawNow();
    });
  }

  drawNow() {
    for (const side of this.sides) side.renderer.render(side.stage, this.camera);
  }

  listen(side) {
    let pressed = null;
    side.canvas.addEventListener('pointerdown', (event) => { pressed = [event.clientX, event.clientY]; });
    side.canvas.addEventListener('pointerup', (event) => {
      if (!pressed || event.button !== 0) return;
      const moved = Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]);
      pressed = null;
      if (moved > 4) return;
      const box = side.canvas.getBoundingClientRect();
      this.pick(((event.clientX - box.left) / box.width) * 2 - 1, 1 - ((event.clientY - box.top) / box.height) * 2);
    });
    side.canvas.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || !this.key(event.key)) return;
      event.preventDefault();
      this.draw();
    });
  }

  /// At a place from -1 to 1 across and up, in both views.
  pick(x, y) {
    this.camera.updateMatrixWorld();
    this.raycaster.setFromCamera(new Vector2(x, y), this.camera);
    const patches = this.sides.map((side) => this.raycaster.intersectObject(side.mesh)[0]?.faceIndex ?? null);
    this.sides.forEach((side, i) => side.markPatch(patches[i]));
    this.onPick(patches);
    this.draw();
  }

  /// Whether the key means something.
  key(key) {
    const turn = Math.PI / 36, step = 0.02 * this.scene.diameter;
    switch (key.length === 1 ? key.toLowerCase() : key) {
      case 'ArrowLeft': this.turn(-turn, 0); return true;
      case 'ArrowRight': this.turn(turn, 0); return true;
      case 'ArrowUp': this.turn(0, turn); return true;
      case 'ArrowDown': this.turn(0, -turn); return true;
      case '+': case '=': this.zoom(0.9); return true;
      case '-': case '_': this.zoom(1 / 0.9); return true;
      case 'w': this.fly(0, step); return true;
      case 's': this.fly(0, -step); return true;
      case 'a': this.fly(-step, 0); return true;
      case 'd': this.fly(step, 0); return true;
      case '0': this.lookFrom(this.view); return true;
      case 'Enter': this.pick(0, 0); return true;
      default: return false;
    }
  }

  axes() {
    const forward = this.target.clone().sub(this.camera.position).normalize();
    return { forward, right: forward.clone().cross(this.camera.up).normalize() };
  }

  /// The camera about the target: to the right, and upwards but never over the top.
  turn(right, up) {
    const offset = this.camera.position.clone().sub(this.target);
    const above = offset.angleTo(this.camera.up);
    const pitch = above - Math.min(Math.max(above - up, 0.02), Math.PI - 0.02);
    offset.applyAxisAngle(this.axes().right, -pitch).applyAxisAngle(this.camera.up, right);
    this.camera.position.copy(this.target).add(offset);
    this.camera.lookAt(this.target);
  }

  zoom(factor) {
    this.camera.position.sub(this.target).multiplyScalar(factor).add(this.target);
  }

  fly(sideways, ahead) {
    const { forward, right } = this.axes();
    const way = right.multiplyScalar(sideways).addScaledVector(forward, ahead);
    this.camera.position.add(way);
    this.target.add(way);
  }
}
