mod build; mod median; mod node; mod ray; mod triangles; mod kernels;
pub use ray::{Hit,Ray,RayMask}; pub use triangles::*;
pub mod proto {
  use super::*; use super::kernels::*; 
  pub use super::build::P;
  pub fn depth(t:&TriangleBvh)->(usize,usize,f32){ (t.pairs.len(), t.triangles.len(), sah(t)) }
  fn sah(t:&TriangleBvh)->f32{ let area=|n:&node::Node|{let d=[n.max[0]-n.min[0],n.max[1]-n.min[1],n.max[2]-n.min[2]];d[0]*d[1]+d[1]*d[2]+d[2]*d[0]};
    let r=area(&t.root); t.pairs.iter().flat_map(|p|p.0.iter()).map(|n|area(n)/r*(if n.count()>0{n.count() as f32}else{1.0})).sum() }
  pub fn single(t:&TriangleBvh, r:&Ray)->(f32,i32,bool){
    let p=single::Probe::new(&t.root,r.origin.to_array(),r.direction.to_array(),(r.near_m,r.far_m),RayMask::ALL);
    let mut n=nearest::Nearest::new(r.far_m); single::closest(t,&p,None,&mut n);
    let un=n.is_unsure(); if un { n=n.again(r.far_m); single::closest(t,&p,None,&mut n);} 
    (n.best.distance, n.best.id, un)
  }
  #[inline(never)]
  pub fn packet<const N:usize>(t:&TriangleBvh, o:[f32;3], d:&[[f32;N];3])->[(f32,i32,bool);N]{
    let mut f=packet::Fan::<N>::new(&t.root,o,d,(&[0.0;N],&[f32::INFINITY;N]),RayMask::ALL);
    let mut n=[nearest::Nearest::new(f32::INFINITY);N]; packet::closest(t,&mut f,None,&mut n);
    std::array::from_fn(|k| {let mut m=n[k]; let un=m.is_unsure(); if un {
      let p=single::Probe::new(&t.root,o,[d[0][k],d[1][k],d[2][k]],(0.0,f32::INFINITY),RayMask::ALL);
      m=m.again(f32::INFINITY); single::closest(t,&p,None,&mut m);}
      (m.best.distance,m.best.id,un)})
  }
}
