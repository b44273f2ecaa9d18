// The surface of one level in 3-D, with what is marked on it.

import {
  AmbientLight, BufferAttribute, BufferGeometry, CanvasTexture, Color, DirectionalLight, DoubleSide, LineBasicMaterial, LineSegments,
  Mesh, MeshLambertMaterial, Object3D, PerspectiveCamera, Points, PointsMaterial, Raycaster, Scene, SRGBColorSpace,
  Vector2, Vector3, WebGLRenderer, WireframeGeometry,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { type Colour, invalidColour, plainColour } from "./colours";

/// What is drawn of a level. Points are between -1 and 1.
export interface Drawing {
  points: Float32Array;
  triangles: Uint16Array;
}

/// What a ray of the view meets first: a vertex of the surface, or of the shape of this name.
export interface Hit {
  shape?: string;
  vertex: number;
}

/// The form of a mark of points. Forms tell kinds apart without colours.
export type Form = "circle" | "square" | "triangle" | "diamond" | "cross";

const outlines: Record<Exclude<Form, "circle">, [number, number][]> = {
  square: [[6, 6], [26, 6], [26, 26], [6, 26]],
  triangle: [[16, 3], [29, 27], [3, 27]],
  diamond: [[16, 1], [31, 16], [16, 31], [1, 16]],
  cross: [[2, 8], [8, 2], [16, 10], [24, 2], [30, 8], [22, 16], [30, 24], [24, 30], [16, 22], [8, 30], [2, 24], [10, 16]],
};

/// Returns the picture of a mark: its form in its colour, with a white rim.
function pictureOf(form: Form, colour: string): CanvasTexture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const context = canvas.getContext("2d");
  if (context) {
    context.beginPath();
    if (form === "circle") context.arc(16, 16, 12, 0, 2 * Math.PI);
    else for (const [x, y] of outlines[form]) context.lineTo(x, y);
    context.closePath();
    context.fillStyle = colour;
    context.fill();
    context.lineWidth = 3;
    context.strokeStyle = "#ffffff";
    context.stroke();
  }
  const texture = new CanvasTexture(canvas);
  texture.colorSpace = SRGBColorSpace;
  return texture;
}

const fieldOfView = 35;
/// Where the camera stands first, seen from the middle.
const firstDirection = new Vector3(0.35, 0.3, 1);
/// The surface is drawn this much farther away, in pixels of slope, so that marks of some pixels lie on top of it.
const markClearance = 5;

function geometryOf(points: Float32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points, 3));
  return geometry;
}

/// Returns the points of the edges that have one triangle only, two for each.
function rimOf(drawing: Drawing): Float32Array {
  const count = drawing.points.length / 3;
  const seen = new Map<number, [number, number] | null>();
  for (let t = 0; t < drawing.triangles.length; t += 3) {
    for (let corner = 0; corner < 3; ++corner) {
      const a = drawing.triangles[t + corner];
      const b = drawing.triangles[t + (corner + 1) % 3];
      const key = Math.min(a, b) * count + Math.max(a, b);
      seen.set(key, seen.has(key) ? null : [a, b]);
    }
  }
  const result: number[] = [];
  for (const edge of seen.values())
    for (const vertex of edge ?? []) result.push(...drawing.points.subarray(3 * vertex, 3 * vertex + 3));
  return Float32Array.from(result);
}

export class SurfaceView {
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.05, 100);
  private readonly controls: OrbitControls;
  private mesh: Mesh<BufferGeometry, MeshLambertMaterial> | undefined;
  private readonly marks = new Map<string, Object3D>();
  private drawing: Drawing | undefined;
  private requested = false;
  /// How far away the camera stands, so that the first surface fills the view.
  private distance = 0;

  /// Throws if the browser has no WebGL.
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    const light = new DirectionalLight(0xffffff, 2.2);
    light.position.set(0.4, 0.6, 1);
    this.camera.add(light);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.1));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.request());
    this.reset();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement as HTMLElement);
    this.resize();
  }

  reset(): void {
    this.camera.position.copy(firstDirection).normalize().multiplyScalar(this.distance || 4);
    this.controls.target.set(0, 0, 0);
    this.controls.update();
    this.request();
  }

  setBackground(colour: string): void {
    this.scene.background = new Color(colour);
    this.request();
  }

  /// Replaces the surface. Its marks are removed.
  setSurface(drawing: Drawing): void {
    this.drawing = drawing;
    if (this.mesh) this.remove(this.mesh);
    for (const name of [...this.marks.keys()]) this.setMark(name, undefined);
    if (!this.distance) {
      this.distance = this.fittingDistance(drawing.points);
      this.reset();
    }
    const geometry = geometryOf(drawing.points);
    geometry.setIndex(new BufferAttribute(drawing.triangles, 1));
    geometry.computeVertexNormals();
    const colours = new Float32Array(drawing.points.length);
    geometry.setAttribute("color", new BufferAttribute(colours, 3));
    const material = new MeshLambertMaterial({
      vertexColors: true, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: markClearance,
      polygonOffsetUnits: markClearance,
    });
    this.mesh = new Mesh(geometry, material);
    this.scene.add(this.mesh);
    this.setColours(undefined);
  }

  /// Colours the vertices; `colourOf` returns nothing for vertices that have no value.
  setColours(colourOf: ((vertex: number) => Colour | undefined) | undefined): void {
    if (!this.mesh) return;
    const attribute = this.mesh.geometry.getAttribute("color") as BufferAttribute;
    const colour = new Color();
    for (let v = 0; v < attribute.count; ++v) {
      colour.setRGB(...(colourOf ? colourOf(v) ?? invalidColour : plainColour), SRGBColorSpace);
      attribute.setXYZ(v, colour.r, colour.g, colour.b);
    }
    attribute.needsUpdate = true;
    this.request();
  }

  setPoints(name: string, points: Float32Array | undefined, colour: string, form: Form, size = 11): void {
    if (!points) {
      this.setMark(name, undefined);
      return;
    }
    const map = pictureOf(form, colour);
    const material = new PointsMaterial({
      map, size: size * this.renderer.getPixelRatio(), sizeAttenuation: false, alphaTest: 0.4,
    });
    this.setMark(name, new Points(geometryOf(points), material));
  }

  /// Shows another surface together with the first one.
  setShape(name: string, drawing: Drawing | undefined, colour: string, opacity: number, edges: boolean): void {
    if (!drawing || opacity <= 0) {
      this.setMark(name, undefined);
      return;
    }
    const geometry = geometryOf(drawing.points);
    geometry.setIndex(new BufferAttribute(drawing.triangles, 1));
    geometry.computeVertexNormals();
    const material = new MeshLambertMaterial({
      color: colour, side: DoubleSide, transparent: opacity < 1, opacity, wireframe: edges,
    });
    const shape = new Mesh(geometry, material);
    shape.name = name;
    this.setMark(name, shape);
  }

  /// Shows or hides the first surface.
  showSurface(shown: boolean): void {
    if (this.mesh) this.mesh.visible = shown;
    this.request();
  }

  setLines(name: string, points: Float32Array | undefined, colour: string): void {
    this.setMark(name, points && new LineSegments(geometryOf(points), new LineBasicMaterial({ color: colour })));
  }

  setWireframe(shown: boolean, colour: string): void {
    const lines = shown && this.mesh ? new WireframeGeometry(this.mesh.geometry) : undefined;
    const material = new LineBasicMaterial({ color: colour, transparent: true, opacity: 0.45 });
    this.setMark("wireframe", lines && new LineSegments(lines, material));
  }

  setRims(shown: boolean, colour: string): void {
    this.setLines("rims", shown && this.drawing ? rimOf(this.drawing) : undefined, colour);
  }

  /// Turns the view by angles in radians, and changes the distance by a factor.
  turn(right: number, up: number, factor: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const axis = new Vector3().crossVectors(offset, this.camera.up).normalize();
    const tilted = offset.clone().applyAxisAngle(axis, up);
    if (tilted.angleTo(this.camera.up) > 0.1 && tilted.angleTo(this.camera.up) < Math.PI - 0.1) offset.copy(tilted);
    offset.applyAxisAngle(this.camera.up, right).multiplyScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.request();
  }

  /// Returns the vertex nearest to where a ray through a place of the canvas meets a surface first.
  /// The place is in pixels of the page; without one it is the middle.
  hitAt(place?: { x: number; y: number }): Hit | undefined {
    const box = this.canvas.getBoundingClientRect();
    const ndc = place
      ? new Vector2((place.x - box.left) / box.width * 2 - 1, 1 - (place.y - box.top) / box.height * 2)
      : new Vector2(0, 0);
    const ray = new Raycaster();
    ray.setFromCamera(ndc, this.camera);
    const surfaces = [this.mesh, ...this.marks.values()].filter(one => one instanceof Mesh && one.visible);
    const hit = ray.intersectObjects(surfaces as Object3D[], false)[0];
    if (!hit?.face) return undefined;
    const points = (hit.object as Mesh<BufferGeometry>).geometry.getAttribute("position");
    const distanceTo = (v: number): number => hit.point.distanceTo(new Vector3().fromBufferAttribute(points, v));
    const vertex = [hit.face.a, hit.face.b, hit.face.c].sort((a, b) => distanceTo(a) - distanceTo(b))[0];
    return { shape: hit.object === this.mesh ? undefined : hit.object.name, vertex };
  }

  /// Returns how far away the camera stands if it sees all points from where it looks first.
  private fittingDistance(points: Float32Array): number {
    const towards = firstDirection.clone().normalize();
    const right = new Vector3().crossVectors(this.camera.up, towards).normalize();
    const upwards = new Vector3().crossVectors(towards, right);
    const slope = Math.tan(fieldOfView / 2 * Math.PI / 180);
    const slopeAcross = slope * Math.max(1, this.camera.aspect);
    const point = new Vector3();
    let distance = 0;
    for (let p = 0; p < points.length; p += 3) {
      point.set(points[p], points[p + 1], points[p + 2]);
      const needed = Math.max(Math.abs(point.dot(right)) / slopeAcross, Math.abs(point.dot(upwards)) / slope);
      distance = Math.max(distance, point.dot(towards) + needed);
    }
    return 1.08 * distance || 4;
  }

  private setMark(name: string, mark: Object3D | undefined): void {
    const old = this.marks.get(name);
    if (old) this.remove(old);
    this.marks.delete(name);
    if (mark) {
      this.marks.set(name, mark);
      this.scene.add(mark);
    }
    this.request();
  }

  private remove(object: Object3D): void {
    this.scene.remove(object);
    const { geometry, material } = object as Mesh;
    geometry.dispose();
    for (const one of Array.isArray(material) ? material : [material]) {
      (one as PointsMaterial).map?.dispose();
      one.dispose();
    }
  }

  private resize(): void {
    const box = (this.canvas.parentElement as HTMLElement).getBoundingClientRect();
    if (box.width < 1 || box.height < 1) return;
    this.renderer.setSize(box.width, box.height, false);
    this.camera.aspect = box.width / box.height;
    // A narrow view still shows all of the surface.
    this.camera.zoom = Math.min(1, this.camera.aspect);
    this.camera.updateProjectionMatrix();
    this.request();
  }

  private request(): void {
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame(() => {
      this.requested = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
}
