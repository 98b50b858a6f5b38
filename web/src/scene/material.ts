// SPDX-License-Identifier: Apache-2.0
// One small shader for every organ: two lights that go with the camera, a colour or a value looked up in the scale, a clip plane,
// and more opacity where a translucent surface is seen edge-on.
import {
  ClampToEdgeWrapping,
  Color,
  DataTexture,
  DoubleSide,
  LinearFilter,
  NoBlending,
  NormalBlending,
  RGBAFormat,
  ShaderMaterial,
  SRGBColorSpace,
  Vector2,
  Vector4,
} from 'three';
import { colourTable } from './colormap';

const VERTEX = /* glsl */ `
attribute float scalar;
varying vec3 vNormal;
varying vec3 vView;
varying vec3 vWorld;
varying float vScalar;
void main() {
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  vNormal = normalMatrix * normal;
  vView = view.xyz;
  vWorld = position;
  vScalar = scalar;
  gl_Position = projectionMatrix * view;
}`;

const FRAGMENT = /* glsl */ `
uniform vec3 colour;
uniform float opacity;
uniform float mapped;
uniform sampler2D scale;
uniform vec2 range;
uniform vec4 clip;
uniform float clipped;
varying vec3 vNormal;
varying vec3 vView;
varying vec3 vWorld;
varying float vScalar;
void main() {
  if (clipped > 0.5 && dot(vWorld, clip.xyz) > clip.w) discard;
  vec3 n = normalize(vNormal);
  vec3 v = normalize(-vView);
  if (dot(n, v) < 0.0) n = -n;
  float t = (vScalar - range.x) / (range.y - range.x);
  vec3 base = mix(colour, texture2D(scale, vec2(clamp(t, 0.002, 0.998), 0.5)).rgb, mapped);
  float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float fill = 0.5 + 0.5 * n.y;
  float shine = pow(max(dot(n, normalize(normalize(vec3(-0.35, 0.55, 0.75)) + v)), 0.0), 28.0);
  vec3 lit = base * (0.34 + 0.16 * fill + 0.62 * key) + vec3(0.05 * shine) * (1.0 - 0.6 * mapped);
  float edge = pow(1.0 - abs(dot(n, v)), 2.2);
  float alpha = opacity < 0.995 ? clamp(opacity * (0.75 + 1.6 * edge), 0.0, 1.0) : 1.0;
  gl_FragColor = vec4(lit, alpha);
  #include <colorspace_fragment>
}`;

const CAP_VERTEX = /* glsl */ `
attribute vec3 tint;
attribute float scalar;
varying vec3 vTint;
varying float vScalar;
void main() {
  vTint = tint;
  vScalar = scalar;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const CAP_FRAGMENT = /* glsl */ `
uniform float mapped;
uniform sampler2D scale;
uniform vec2 range;
varying vec3 vTint;
varying float vScalar;
void main() {
  float t = (vScalar - range.x) / (range.y - range.x);
  vec3 value = texture2D(scale, vec2(clamp(t, 0.002, 0.998), 0.5)).rgb;
  gl_FragColor = vec4(mix(vTint * 0.93, value, vScalar < -1.0e8 ? 0.0 : mapped), 1.0);
  #include <colorspace_fragment>
}`;

/** Uniforms that all organs share: the same objects in every material. */
export class SharedUniforms {
  readonly scale: { value: DataTexture };
  readonly mapped = { value: 0 };
  readonly range = { value: new Vector2(0, 1) };
  readonly clip = { value: new Vector4(0, 1, 0, 0) };

  constructor() {
    const texture = new DataTexture(colourTable(256), 256, 1, RGBAFormat);
    texture.colorSpace = SRGBColorSpace;
    texture.magFilter = texture.minFilter = LinearFilter;
    texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
    texture.needsUpdate = true;
    this.scale = { value: texture };
  }
}

export function organMaterial(shared: SharedUniforms, colour: string, opacity: number): ShaderMaterial {
  const material = new ShaderMaterial({
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: DoubleSide,
    uniforms: {
      colour: { value: new Color(colour) },
      opacity: { value: opacity },
      clipped: { value: 0 },
      mapped: shared.mapped,
      scale: shared.scale,
      range: shared.range,
      clip: shared.clip,
    },
  });
  material.forceSinglePass = true;
  setOpacity(material, opacity);
  return material;
}

export function setOpacity(material: ShaderMaterial, opacity: number): void {
  material.uniforms.opacity.value = opacity;
  const translucent = opacity < 0.995;
  material.transparent = translucent;
  material.depthWrite = true;
  material.blending = translucent ? NormalBlending : NoBlending;
}

export function capMaterial(shared: SharedUniforms): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: CAP_VERTEX,
    fragmentShader: CAP_FRAGMENT,
    side: DoubleSide,
    uniforms: { mapped: shared.mapped, scale: shared.scale, range: shared.range },
  });
}
