// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "pqVoxplexMeshing.h"

#include "vtkSMLabelColorsProxy.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqProgressManager.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"

#include "vtkAlgorithm.h"
#include "vtkNew.h"
#include "vtkSMSourceProxy.h"

#include <QCoreApplication>

namespace
{

/** Those of the plugin's filters that take long. */
bool IsMesher(vtkObjectBase* object)
{
  return object && object->IsA("vtkImageToSimplexMeshFilter");
}

/** Whether a proxy is a filter of the plugin, so that the array Label has labels whether or not they have names. */
bool IsMeshOfOurs(vtkSMProxy* proxy)
{
  const QString name = proxy->GetXMLName();
  return name == "VoxplexTetMesh" || name == "VoxplexPentatopeMesh";
}

} // namespace

pqVoxplexMeshing::pqVoxplexMeshing(QObject* parent)
  : QObject(parent)
{
}

void pqVoxplexMeshing::startup()
{
  pqApplicationCore* const core = pqApplicationCore::instance();
  pqProgressManager* const progress = core->getProgressManager();
  this->connect(
    progress, SIGNAL(progress(const QString&, int)), SLOT(onProgress(const QString&, int)));
  this->connect(progress, SIGNAL(progressEndEvent()), SLOT(onProgressEnd()));
  this->connect(progress, SIGNAL(abort()), SLOT(onAbort()));
  this->connect(core->getServerManagerModel(), SIGNAL(dataUpdated(pqPipelineSource*)),
    SLOT(onDataUpdated(pqPipelineSource*)));
}

void pqVoxplexMeshing::shutdown()
{
  if (pqApplicationCore* const core = pqApplicationCore::instance())
  {
    core->getProgressManager()->disconnect(this);
    core->getServerManagerModel()->disconnect(this);
  }
}

void pqVoxplexMeshing::onProgress(const QString& message, int percent)
{
  // The message is the class of the filter that executes, without "vtk".
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!message.startsWith("ImageTo") || !message.endsWith("MeshFilter") || server == nullptr ||
    server->isRemote() || this->HandlesEvents)
  {
    return;
  }
  if (!this->CanAbort)
  {
    this->CanAbort = true;
    pqApplicationCore::instance()->getProgressManager()->setEnableAbort(true);
  }
  if (percent >
    0) // as newer versions of ParaView do; the progress manager keeps all but the button from mouse and keys
  {
    this->HandlesEvents = true;
    QCoreApplication::processEvents();
    this->HandlesEvents = false;
  }
}

void pqVoxplexMeshing::onProgressEnd()
{
  if (this->CanAbort)
  {
    this->CanAbort = false;
    pqApplicationCore::instance()->getProgressManager()->setEnableAbort(false);
  }
}

void pqVoxplexMeshing::onAbort()
{
  if (!this->CanAbort)
  {
    return;
  }
  const auto sources =
    pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  for (pqPipelineSource* source : sources)
  {
    vtkObjectBase* const object = source->getProxy()->GetClientSideObject();
    if (IsMesher(object))
    {
      // The one that does not execute forgets it when it starts the next time.
      vtkAlgorithm::SafeDownCast(object)->SetAbortExecute(1);
    }
  }
}

void pqVoxplexMeshing::onDataUpdated(pqPipelineSource* source)
{
  vtkSMSourceProxy* const proxy = source->getSourceProxy();
  if (proxy == nullptr || !(IsMeshOfOurs(proxy) || vtkSMLabelColorsProxy::HasLabels(proxy, 0)))
  {
    return;
  }
  vtkNew<vtkPVLabelInformation> labels;
  vtkSMLabelColorsProxy::Gather(proxy, 0, labels);
  if (!labels->GetLabels().empty() && labels->GetLabels() != this->Applied)
  {
    this->Applied = labels->GetLabels();
    vtkSMLabelColorsProxy::Apply(labels, proxy->GetSessionProxyManager());
  }
}
