// Hands triangles on by number; the geometry stage fetches them.
flat out uint vertex_primitive;

void main() {
  vertex_primitive = uint(gl_VertexID);
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
