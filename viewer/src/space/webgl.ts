// The stage drawn by three.js.

import {
  AmbientLight, BufferAttribute, BufferGeometry, Color, ConeGeometry, CylinderGeometry, DirectionalLight, DoubleSide, DynamicDrawUsage, GridHelper,
  Group, InstancedMesh, Line as Polyline, LineBasicMaterial, Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, PlaneGeometry,
  Quaternion, Scene, Sphere, SphereGeometry, Vector3, WebGLRenderer,
} from "three";
import type { Shape } from "../data/run.ts";
import { ANGLE, eye } from "./orbit.ts";
import { kindColour, styled, type Picture } from "./picture.ts";
import { geometry } from "./solids.ts";
import { CELLS, type Surface } from "../data/sea.ts";
import { WATER, type LineActor, type Stage } from "./stage.ts";
import { SIDES, tube, tubeIndex, type Tube } from "./tube.ts";

interface TubeMesh {
  actor: LineActor;
  mesh: Mesh;
  buffers: Tube;
  colours: Float32Array;
  count: number;
}

/** Three takes colours of corners as linear light. */
const linear = Float32Array.from({ length: 256 }, (_, i) => (i / 255) ** 2.2);

/** Whether the processor draws: smooth edges then cost half of the frames. */
function bySoftware(): boolean {
  const gl = document.createElement("canvas").getContext("webgl2");
  const info = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = gl ? String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

export class Webgl implements Picture {
  readonly kind = "webgl";
  readonly canvas: HTMLCanvasElement;
  private renderer: WebGLRenderer;
  private scene = new Scene();
  private camera = new PerspectiveCamera((ANGLE * 180) / Math.PI, 1, 0.1, 1e5);
  /** What is given on the ground, moved so that the frame stands still. */
  private ground = new Group();
  private tubes: TubeMesh[];
  private bodies: { group: Group; point: boolean }[];
  private trail: Polyline;
  /** Shafts and heads of all arrows. */
  private arrows: [InstancedMesh, InstancedMesh] | null;
  private grids: GridHelper[] = [];
  private solids: MeshLambertMaterial[] = [];
  private seas: MeshBasicMaterial[] = [];
  /** The surface of waves. */
  private waves: Mesh | null = null;
  private light = new DirectionalLight(0xffffff, 1.6);

  constructor(stage: Stage) {
    this.renderer = new WebGLRenderer({ antialias: !bySoftware(), powerPreference: "high-performance" });
    this.canvas = this.renderer.domElement;
    this.scene.add(this.ground, new AmbientLight(0xffffff, 2), this.light);
    this.tubes = stage.lines.map((actor) => this.tube(actor));
    this.bodies = stage.field.bodies.map((body) => {
      const group = new Group();
      for (const shape of body.shapes) group.add(this.solid(shape, stage.size, "--body"));
      if (body.shapes.length === 0) group.add(new Mesh(new SphereGeometry(1, 16, 12), this.material("--point")));
      this.ground.add(group);
      return { group, point: body.shapes.length === 0 };
    });
    for (const shape of stage.field.shapes) this.ground.add(this.solid(shape, stage.size, "--solid"));
    this.levels(stage);
    this.trail = new Polyline(new BufferGeometry(), new LineBasicMaterial({ transparent: true, opacity: 0.8 }));
    this.trail.frustumCulled = false;
    this.trail.geometry.boundingSphere = new Sphere();
    this.scene.add(this.trail);
    this.arrows = this.arrow(stage.arrows.actors.length);
    this.recolour(stage);
  }

  private material(colour: string, extra = {}): MeshLambertMaterial {
    const material = new MeshLambertMaterial({ ...extra });
    material.userData.colour = colour;
    this.solids.push(material);
    return material;
  }

  private solid(shape: Shape, reach: number, colour: string): Mesh {
    const open = shape.solid.type === "tube" || shape.solid.type === "plane";
    const look = open ? { side: DoubleSide, transparent: true, opacity: 0.45, depthWrite: false } : { flatShading: shape.solid.type === "mesh" };
    const mesh = new Mesh(geometry(shape.solid, reach), this.material(colour, look));
    mesh.position.fromArray(shape.pose.position);
    const [w, x, y, z] = shape.pose.orientation;
    mesh.quaternion.set(x, y, z, w);
    // a shape on a body is counted from the body, one on the ground from the origin of the field
    return mesh;
  }

  private tube(actor: LineActor): TubeMesh {
    const most = actor.x.length / 3;
    const buffers = { positions: new Float32Array(3 * SIDES * most), normals: new Float32Array(3 * SIDES * most) };
    const colours = new Float32Array(3 * SIDES * most);
    const shape = new BufferGeometry();
    const dynamic = (values: Float32Array) => new BufferAttribute(values, 3).setUsage(DynamicDrawUsage);
    shape.setAttribute("position", dynamic(buffers.positions));
    shape.setAttribute("normal", dynamic(buffers.normals));
    shape.setAttribute("color", dynamic(colours));
    shape.setIndex(new BufferAttribute(tubeIndex(most), 1));
    // what changes with every frame is never found outside of the view
    shape.boundingSphere = new Sphere();
    const mesh = new Mesh(shape, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
    mesh.frustumCulled = false;
    this.ground.add(mesh);
    return { actor, mesh, buffers, colours, count: 0 };
  }

  /** Shafts and heads of unit size, along y from the origin. */
  private arrow(count: number): [InstancedMesh, InstancedMesh] | null {
    if (count === 0) return null;
    const shaft = new CylinderGeometry(1, 1, 1, 8).translate(0, 0.5, 0);
    const head = new ConeGeometry(1, 1, 12).translate(0, 0.5, 0);
    const make = (shape: BufferGeometry) => {
      const mesh = new InstancedMesh(shape, new MeshLambertMaterial({ color: 0xffffff }), count);
      mesh.frustumCulled = false;
      this.ground.add(mesh);
      return mesh;
    };
    return [make(shaft), make(head)];
  }

  /** The surface of the water and the sea bed, or a grid below everything. */
  private levels(stage: Stage): void {
    const { field, size, whole } = stage;
    const [low, high] = whole;
    const [x, y] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const side = WATER * size;
    const put = (z: number, sea: boolean) => {
      const plane = new Mesh(new PlaneGeometry(side, side), new MeshBasicMaterial({ transparent: true, opacity: sea ? 0.13 : 0.3, side: DoubleSide, depthWrite: false }));
      plane.material.userData.colour = sea ? "--sea" : "--bed";
      plane.position.set(x, y, z);
      this.seas.push(plane.material);
      this.ground.add(plane);
    };
    const grid = (z: number) => {
      const lines = new GridHelper(side, 24);
      lines.rotation.x = Math.PI / 2;
      lines.position.set(x, y, z);
      Object.assign(lines.material, { transparent: true, opacity: 0.35, depthWrite: false, vertexColors: false });
      this.grids.push(lines);
      this.ground.add(lines);
    };
    const { water, bed, origin } = field;
    if (water !== null && stage.sea) this.waves = this.surface(stage.sea, water - origin[2]);
    else if (water !== null) put(water - origin[2], true);
    if (bed !== null) put(bed - origin[2], false);
    if (bed !== null) grid(bed - origin[2]);
    else if (water !== null) grid(water - origin[2]);
    else grid(low[2] - 0.02 * size);
  }

  /** A square of water whose corners rise and fall. */
  private surface({ low, side }: Surface, z: number): Mesh {
    const shape = new PlaneGeometry(side, side, CELLS, CELLS);
    (shape.getAttribute("position") as BufferAttribute).setUsage(DynamicDrawUsage);
    shape.setAttribute("color", new BufferAttribute(new Float32Array(3 * (CELLS + 1) ** 2), 3).setUsage(DynamicDrawUsage));
    shape.boundingSphere = new Sphere();
    const mesh = new Mesh(shape, this.material("--sea", { transparent: true, opacity: 0.45, side: DoubleSide, depthWrite: false, vertexColors: true }));
    mesh.frustumCulled = false;
    mesh.position.set(low[0] + side / 2, low[1] + side / 2, z);
    this.ground.add(mesh);
    return mesh;
  }

  private drawWaves({ heights, deviation }: Surface): void {
    const shape = this.waves!.geometry;
    const [place, colour] = ["position", "color"].map((name) => shape.getAttribute(name) as BufferAttribute) as [BufferAttribute, BufferAttribute];
    const n = CELLS + 1;
    for (let j = 0; j < n; j++) {
      for (let k = 0; k < n; k++) {
        // three.js begins with the row of the largest y
        const [i, height] = [(n - 1 - j) * n + k, heights[j * n + k]!];
        place.setZ(i, height);
        // crests are light and troughs are dark: light alone shows little of slopes as low as these
        const light = 0.75 + 0.35 * Math.max(-1.5, Math.min(1.5, height / (deviation || 1)));
        colour.setXYZ(i, light, light, light);
      }
    }
    place.needsUpdate = colour.needsUpdate = true;
    shape.computeVertexNormals();
  }

  resize(width: number, height: number, ratio: number): void {
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
  }

  recolour(stage: Stage): void {
    const set = (of: { color: Color; userData: Record<string, unknown> }) => of.color.set(styled(of.userData.colour as string));
    this.solids.forEach(set);
    this.seas.forEach(set);
    for (const grid of this.grids) (grid.material as LineBasicMaterial).color.set(styled("--grid"));
    (this.trail.material as LineBasicMaterial).color.set(styled("--trail"));
    stage.arrows.actors.forEach(({ kind }, i) => this.arrows?.forEach((mesh) => mesh.setColorAt(i, new Color(kindColour(kind)))));
    this.arrows?.forEach((mesh) => mesh.instanceColor && (mesh.instanceColor.needsUpdate = true));
    this.scene.background = new Color(styled("--space"));
  }

  draw(stage: Stage): void {
    const { x, angle } = stage.stand;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    this.ground.rotation.z = -angle;
    this.ground.position.set(-c * x[0] - s * x[1], s * x[0] - c * x[1], -x[2]);
    if (stage.sea && this.waves) this.drawWaves(stage.sea);
    for (const one of this.tubes) this.drawTube(one, stage.drawn(one.actor.line) / 2);
    const from = eye(stage.orbit);
    this.bodies.forEach(({ group, point }, i) => {
      const { x: at, q } = stage.poses[i]!;
      group.visible = at.every(Number.isFinite);
      group.position.fromArray(at);
      group.quaternion.set(q[1], q[2], q[3], q[0]);
      // a point is as large from wherever it is seen
      if (point) group.scale.setScalar(0.007 * stage.orbit.distance);
    });
    this.drawTrail(stage);
    this.drawArrows(stage);
    this.camera.position.fromArray(from);
    this.camera.up.set(0, 0, 1);
    // from straight above there is no up but that of the azimuth
    if (Math.abs(stage.orbit.elevation) > 1.55) this.camera.up.set(-Math.cos(stage.orbit.azimuth), -Math.sin(stage.orbit.azimuth), 0).multiplyScalar(Math.sign(stage.orbit.elevation));
    this.camera.lookAt(...stage.orbit.target);
    this.camera.near = stage.orbit.distance / 500;
    this.camera.far = stage.orbit.distance * 5 + 8 * stage.size;
    this.camera.updateProjectionMatrix();
    this.light.position.set(from[0] - stage.orbit.target[0], from[1] - stage.orbit.target[1], from[2] - stage.orbit.target[2]).normalize();
    this.light.position.z += 0.8;
    this.renderer.render(this.scene, this.camera);
  }

  private drawTube(one: TubeMesh, radius: number): void {
    const { actor, mesh, buffers, colours } = one;
    tube(actor.x, actor.count, radius, buffers);
    for (let i = 0; i < actor.count; i++) {
      for (let j = 0; j < 3; j++) {
        const value = linear[Math.round(255 * actor.colour[3 * i + j]!)]!;
        for (let k = 0; k < SIDES; k++) colours[3 * (i * SIDES + k) + j] = value;
      }
    }
    for (const name of ["position", "normal", "color"]) mesh.geometry.getAttribute(name).needsUpdate = true;
    mesh.geometry.setDrawRange(0, Math.max(0, actor.count - 1) * SIDES * 6);
  }

  private drawTrail(stage: Stage): void {
    const shape = this.trail.geometry;
    if (stage.reached > 0 && shape.getAttribute("position")?.array !== stage.trail) shape.setAttribute("position", new BufferAttribute(stage.trail, 3));
    shape.setDrawRange(stage.since, stage.reached - stage.since);
    this.trail.visible = stage.reached - stage.since > 1;
  }

  private drawArrows(stage: Stage): void {
    if (!this.arrows) return;
    const { actors, scale } = stage.arrows;
    // as thick from wherever they are seen
    const thick = 0.0022 * stage.orbit.distance;
    const [up, along, place, size, turn, matrix] = [new Vector3(0, 1, 0), new Vector3(), new Vector3(), new Vector3(), new Quaternion(), new Matrix4()];
    const [shafts, heads] = this.arrows;
    let shown = 0;
    for (const [i, { x, f, seen }] of actors.entries()) {
      along.fromArray(f).multiplyScalar(scale);
      const length = along.length();
      const head = seen ? Math.min(9 * thick, 0.5 * length) : 0;
      turn.setFromUnitVectors(up, length > 0 ? along.divideScalar(length) : up);
      shafts.setMatrixAt(i, matrix.compose(place.fromArray(x), turn, seen ? size.set(thick, length - head, thick) : size.set(0, 0, 0)));
      place.fromArray(x).addScaledVector(along, length - head);
      heads.setMatrixAt(i, matrix.compose(place, turn, size.set(0.35 * head, head, 0.35 * head)));
      shown += Number(seen);
    }
    for (const mesh of this.arrows) {
      mesh.visible = shown > 0;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }
}
