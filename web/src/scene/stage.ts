// SPDX-License-Identifier: Apache-2.0
// Renderer, camera and its saved views. Draws only when something has changed.
import { Box3, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

export type ViewName = 'oblique' | 'front' | 'right' | 'left' | 'back' | 'vulva' | 'above';

/** Where the camera looks from (RAS), and the direction that is up in the picture. */
export const VIEWS: Record<ViewName, { label: string; from: [number, number, number]; up: [number, number, number] }> = {
  oblique: { label: 'Oblique', from: [0.8, 1, 0.22], up: [0, 0, 1] },
  front: { label: 'Front', from: [0, 1, 0], up: [0, 0, 1] },
  right: { label: 'Right side', from: [1, 0, 0], up: [0, 0, 1] },
  left: { label: 'Left side', from: [-1, 0, 0], up: [0, 0, 1] },
  back: { label: 'Back', from: [0, -1, 0], up: [0, 0, 1] },
  vulva: { label: 'From the vulva', from: [0, 0.5, -0.86], up: [0, 0, 1] },
  above: { label: 'From above', from: [0, -0.001, 1], up: [0, 0, 1] },
};

const FIELD_OF_VIEW = 26;
/** A picture that has not changed for so long stands still. */
const STILL_MS = 400;

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 20);
  readonly controls: OrbitControls;
  readonly renderer: WebGLRenderer;
  readonly canvas: HTMLCanvasElement;
  private bounds = new Box3(new Vector3(-0.2, -0.2, -0.2), new Vector3(0.2, 0.2, 0.2));
  private stale = true;
  private flight: { start: number; from: Vector3; to: Vector3; target: Vector3; fromTarget: Vector3 } | null = null;
  private slow = 0;
  private ratio: number;
  private fullRatio = Math.min(2, window.devicePixelRatio || 1);
  /** Pixels per CSS pixel while things move; those that stand still are drawn in full. */
  private movingRatio: number;
  private lastDrawn = 0;
  private moving = false;
  private quietTicks = 0;
  private watcher: ResizeObserver;
  /** Called after each picture. */
  onDrawn: () => void = () => undefined;

  /** Throws if the browser has no WebGL 2. */
  constructor(private host: HTMLElement) {
    const software = rendersInSoftware();
    if (software) this.fullRatio = Math.min(1, this.fullRatio);
    this.ratio = this.movingRatio = this.fullRatio;
    this.renderer = new WebGLRenderer({ antialias: !software, alpha: true, powerPreference: 'high-performance' });
    this.renderer.setClearColor(0, 0);
    this.canvas = this.renderer.domElement;
    host.append(this.canvas);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener('change', () => this.redraw());
    this.controls.addEventListener('start', () => (this.flight = null));
    this.watcher = new ResizeObserver(() => this.resize());
    this.watcher.observe(host);
    this.resize();
    this.look('oblique', false);
  }

  /** Moves the camera on and draws if anything has changed since the last picture. `seconds`: since the tick before. */
  tick(now: number, seconds: number): void {
    this.fly(now);
    this.controls.update();
    if (this.stale) {
      // A single change is drawn in full, what goes on moving in fewer pixels if need be.
      if (this.moving) this.setRatio(this.movingRatio);
      this.moving = true;
      this.quietTicks = 0;
      this.draw(seconds);
      this.lastDrawn = now;
    } else if (this.moving && ++this.quietTicks >= 3 && now - this.lastDrawn > STILL_MS) {
      this.moving = false;
      this.setRatio(this.fullRatio);
    }
  }

  get pixelRatio(): number {
    return this.ratio;
  }

  redraw(): void {
    this.stale = true;
  }

  private draw(seconds: number): void {
    this.stale = false;
    this.render();
    // Where pictures come slowly (software rendering), fewer pixels make it usable.
    this.slow = seconds > 0.07 ? this.slow + 1 : Math.max(0, this.slow - 1);
    if (this.slow > 8 && this.movingRatio > 0.5) {
      this.movingRatio = this.movingRatio > 1 ? 1 : Math.max(0.5, this.movingRatio - 0.25);
      this.slow = 0;
    }
  }

  private render(): void {
    this.renderer.render(this.scene, this.camera);
    this.onDrawn();
  }

  /** Draws now, whatever the loop does, so that the canvas can be read; in full sharpness if `sharp`. */
  drawNow(sharp: boolean): void {
    if (sharp) this.setRatio(this.fullRatio);
    this.render();
  }

  private setRatio(ratio: number): void {
    if (ratio === this.ratio) return;
    this.ratio = ratio;
    this.resize();
  }

  private resize(): void {
    const width = Math.max(1, this.host.clientWidth);
    const height = Math.max(1, this.host.clientHeight);
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.redraw();
  }

  /** Fits saved views to what there is to see. */
  setBounds(box: Box3): void {
    this.bounds.copy(box);
    const radius = 0.5 * box.getSize(new Vector3()).length();
    this.camera.near = radius / 50;
    this.camera.far = radius * 60;
    this.camera.updateProjectionMatrix();
  }

  look(view: ViewName, smooth = true): void {
    const { from } = VIEWS[view];
    this.lookFrom(new Vector3(...from), smooth);
  }

  lookFrom(direction: Vector3, smooth = true): void {
    const target = this.bounds.getCenter(new Vector3());
    const to = direction.clone().normalize().multiplyScalar(this.distanceFor(direction)).add(target);
    const still = !smooth || window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (still) {
      this.flight = null;
      this.camera.position.copy(to);
      this.controls.target.copy(target);
      this.controls.update();
    } else {
      this.flight = { start: performance.now(), from: this.camera.position.clone(), to, target, fromTarget: this.controls.target.clone() };
    }
    this.redraw();
  }

  /** How far away the camera must be for all corners of the bounds to be in the picture, with a margin. */
  private distanceFor(direction: Vector3): number {
    const forward = direction.clone().normalize().negate();
    const right = forward.clone().cross(this.camera.up).normalize();
    const up = right.clone().cross(forward);
    const half = this.bounds.getSize(new Vector3()).multiplyScalar(0.5);
    const tangent = Math.tan((Math.PI / 360) * this.camera.fov);
    let distance = 0;
    for (let k = 0; k < 8; k++) {
      const corner = new Vector3(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
      const sideways = Math.max(Math.abs(corner.dot(up)) / tangent, Math.abs(corner.dot(right)) / (tangent * this.camera.aspect));
      distance = Math.max(distance, sideways - corner.dot(forward));
    }
    return 1.04 * distance;
  }

  private fly(now: number): void {
    const flight = this.flight;
    if (!flight) return;
    const u = Math.min(1, (now - flight.start) / 380);
    const f = u * u * (3 - 2 * u);
    // Along an arc about the target, so that the distance does not dip on the way.
    const a = flight.from.clone().sub(flight.fromTarget);
    const b = flight.to.clone().sub(flight.target);
    const direction = a.clone().normalize().lerp(b.clone().normalize(), f);
    if (direction.lengthSq() < 1e-4) direction.set(1, 0, 0);
    this.controls.target.lerpVectors(flight.fromTarget, flight.target, f);
    this.camera.position.copy(direction.normalize().multiplyScalar(a.length() + f * (b.length() - a.length()))).add(this.controls.target);
    if (u >= 1) this.flight = null;
    this.redraw();
  }

  /** Turns the camera about its target [rad] or changes its distance by a factor; for the keyboard. */
  orbit(azimuth: number, polar: number, zoom = 1): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const r = offset.length() * zoom;
    const phi = Math.min(Math.PI - 0.01, Math.max(0.01, Math.acos(offset.z / offset.length()) + polar));
    const theta = Math.atan2(offset.y, offset.x) + azimuth;
    offset.set(Math.sin(phi) * Math.cos(theta), Math.sin(phi) * Math.sin(theta), Math.cos(phi)).multiplyScalar(r);
    this.flight = null;
    this.camera.position.copy(this.controls.target).add(offset);
    this.redraw();
  }

  /** Where a point is on the host element, in CSS pixels; false if it is behind the camera. */
  project(point: Vector3, out: { x: number; y: number }): boolean {
    const v = SCRATCH.copy(point).project(this.camera);
    out.x = (0.5 + 0.5 * v.x) * this.host.clientWidth;
    out.y = (0.5 - 0.5 * v.y) * this.host.clientHeight;
    return v.z < 1;
  }

  pose(): { position: number[]; target: number[] } {
    return { position: this.camera.position.toArray(), target: this.controls.target.toArray() };
  }
  setPose(pose: { position: number[]; target: number[] }): void {
    this.camera.position.fromArray(pose.position);
    this.controls.target.fromArray(pose.target);
    this.controls.update();
    this.redraw();
  }

  dispose(): void {
    this.watcher.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }
}

const SCRATCH = new Vector3();

/** Whether the pictures are computed without a graphics card: then edges are not smoothed, which costs the most. */
function rendersInSoftware(): boolean {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
