// A face in memory: its vertices and its dual basis, 15 numbers and one unused.

alias FaceRecord = array<vec4<real>, FACE_VECTORS>;

fn face_pack(face: Face) -> FaceRecord {
    return FaceRecord(
        vec4<real>(face.a, face.b.x),
        vec4<real>(face.b.yz, face.c.xy),
        vec4<real>(face.c.z, face.dual1),
        vec4<real>(face.dual2, real(0.0)),
    );
}

fn face_unpack(record: FaceRecord) -> Face {
    return face_again(
        record[0].xyz,
        vec3<real>(record[0].w, record[1].xy),
        vec3<real>(record[1].zw, record[2].x),
        record[2].yzw,
        record[3].xyz,
    );
}
